// Where a flight can end, at home or at a relay's landing spot, and how long it takes to get there. It is
// asked every second, and for every goal before it is accepted.
//
// It lives on the map lane.
#pragma once
#include <optional>

#include "core_stack/mission/policy/policy_port.h"
#include "core_stack/mission/world_model/team_membership.h"
#include "core_stack/mission/world_model/world_model.h"

namespace karst::core {

struct HomeEstimate {
  double length_m = 0, time_s = 0;
};

class HomeEstimator {
 public:
  /// `world` and `team` outlive it.
  HomeEstimator(const CoreOptions& options, const VehicleDescription& vehicle, WorldModel& world,
                const TeamMembership& team);

  /// Home or a landing spot, whichever takes less time: through the map, or if it knows no path home,
  /// `flown_m` long.
  HomeEstimate estimate(const Vec3& from, double flown_m);
  /// Where to land as a relay, if that takes less time than the path home. The ground here is judged too.
  std::optional<LandingSpot> landing_spot(const Vec3& from, double flown_m);
  /// Seconds of flight left before the vehicle must turn back.
  double slack_s(double seconds_left, const HomeEstimate& home) const;
  /// A teammate reports its battery, not its plans: when it must turn back is worked out on one's own map, as
  /// for oneself.
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
