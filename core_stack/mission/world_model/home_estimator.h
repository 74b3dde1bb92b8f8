// Estimates where a flight can end, at home or at a relay landing site, and how long it takes to get there.
// It is called every second, and for every goal before it is accepted.
//
// It runs on the map lane.
#pragma once
#include <optional>

#include "core_stack/mission/policy/policy_port.h"
#include "core_stack/mission/world_model/team_membership.h"
#include "core_stack/mission/world_model/world_model.h"

namespace karst::core {

struct HomeEstimate {
  double length_m = 0, time_s = 0;
  bool by_map = true;  // else the flown path stands in for it
};

class HomeEstimator {
 public:
  /// `world` and `team` must outlive it.
  HomeEstimator(const CoreOptions& options, const VehicleDescription& vehicle, WorldModel& world,
                const TeamMembership& team);

  /// Home or a landing site, whichever takes less time. If the map shows no path home, its length is taken as
  /// `flown_m`.
  HomeEstimate estimate(const Vec3& from, double flown_m);
  /// Where to land as a relay, if that takes less time than flying home. Also judges the ground right here.
  std::optional<LandingSpot> landing_spot(const Vec3& from, double flown_m);
  /// Seconds of flight left before the vehicle must turn back.
  double slack_s(double seconds_left, const HomeEstimate& home) const;
  /// A teammate reports its battery, not when it must turn back: that is estimated on this vehicle's own map,
  /// as for this vehicle itself.
  OtherVehicle seen_by_policy(const TeammateState& teammate, TimeNs now);

 private:
  HomeEstimate to_start(const Vec3& from, double flown_m);
  std::optional<LandingSpot> nearest_spot(const Vec3& from, double sooner_than_s);
  double time_home_s(double length_m) const;
  double extra_time_s(const Path& path) const;

  MotionLimits motion_;
  double home_margin_, home_reserve_s_;
  double landing_speed_mps_, slow_speed_mps_;
  double ground_z_m_;  // at the start
  WorldModel* world_;
  const TeamMembership* team_;
};

}  // namespace karst::core
