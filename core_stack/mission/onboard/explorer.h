// All work on the map: it integrates rays, decides where to explore next, and plans paths.
//
// An Explorer runs on the map lane of the executive. Its calls run one after another, so the map needs no
// lock and does not change during a decision. It owns the parts that do the work, and forwards each call to
// one of them.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mission/decision/cycle.h"
#include "core_stack/mission/decision/decision_cycle.h"
#include "core_stack/mission/decision/horizon_guide.h"
#include "core_stack/mission/options/mission_options.h"
#include "core_stack/mission/policy/policy_port.h"
#include "core_stack/mission/world_model/clearance_checks.h"
#include "core_stack/mission/world_model/home_estimator.h"
#include "core_stack/mission/world_model/team_membership.h"
#include "core_stack/mission/world_model/world_model.h"
#include "core_stack/team/relay_homing.h"
#include "core_stack/team/right_of_way/waiting_place.h"

namespace karst::core {

class Explorer {
 public:
  /// `policy` must outlive it.
  Explorer(const CoreOptions& options, const VehicleDescription& vehicle, PolicyPort& policy);
  Explorer(const Explorer&) = delete;  // its parts refer to each other
  Explorer& operator=(const Explorer&) = delete;

  /// Integrates one sensor's rays into the map; returns the changed cells.
  std::vector<CellChange> integrate(const std::vector<Ray>& rays);
  std::vector<CellChange> declare_launch_site(const Vec3& hover_point);
  /// See WorldModel::take_earlier.
  std::vector<CellChange> take_earlier(std::span<const CellValue> cells) {
    return world_.take_earlier(cells);
  }

  /// Notes a picture of the vehicle's colour camera, taken from that pose.
  void note_picture(const Pose& T_world_camera);

  CycleResult decide(const CycleInput& input);
  /// See HorizonGuide::plan.
  std::optional<HorizonPlan> plan_horizon(const HorizonQuery& query, std::optional<double> exploring_s);
  /// Plans a path home or around a new obstacle.
  Path plan_to(const Vec3& from, const Vec3& to);
  /// Estimates the return home. If the map shows no path, its length is taken as `flown_length_m`.
  HomeEstimate estimate_home(const Vec3& from, double flown_length_m);
  /// The flown path reversed and continued to home, with loops cut where the map shows a clear line.
  std::vector<Vec3> path_back(const std::vector<Vec3>& flown) const;
  /// Notifies the policy of its goals' fates and of the end of exploration.
  void tell(const std::vector<PolicyEvent>& events, TimeNs now);
  /// Index of the first segment of `points` within the vehicle's radius of an obstacle cell, or -1.
  int touching_segment(const std::vector<Vec3>& points) const;
  /// Index of the first segment of `points` that lacks clearance in the current map, or -1. Near the path's
  /// `narrow_places` less clearance is required.
  int blocked_segment(const std::vector<Vec3>& points, const std::vector<Vec3>& narrow_places) const;
  /// Distance of the vehicle's hull at `p` from the nearest obstacle cell; nothing if that is far.
  std::optional<double> hull_clearance_m(const Vec3& p) const;
  /// Where to hover between the launch position and `highest`, straight above it: as high as the usual
  /// clearance allows, or halfway between floor and roof where there is less room.
  Vec3 hover_below(const Vec3& highest) const;
  /// Whether the cluster is still open enough to be worth flying to.
  bool cluster_alive(std::uint32_t id) const;

  // In a team.
  void join(RelayHoming* homing, double claim_radius_m);
  /// Applies what the team has reported; returns the facts to publish.
  TreeFacts share(const Vec3& here, const TeamNews& news);
  /// See RelayHoming::relay_drop_site.
  std::optional<Vec3> relay_drop_site(const Release& here, const Release& ahead) const;
  /// Where to land as a relay, if that takes less time than flying to the start.
  std::optional<LandingSpot> landing_spot(const Vec3& from, double flown_length_m);
  /// Reports the landing below `hover`; returns the facts to publish.
  TreeFacts land(const Vec3& hover, TimeNs team_time);
  /// Finds where to make room for another vehicle; fills in the vehicle's radius.
  std::optional<WaitingPlace> find_waiting_place(RoomQuery query);

  const VoxelMap& map() const { return world_.map(); }
  /// See WorldModel::unsurveyed_m3.
  std::optional<double> unsurveyed_m3() const { return world_.unsurveyed_m3(); }
  const Vec3& home() const { return world_.home(); }
  /// Moves home to the actual hover, if take-off had to stop lower than planned.
  void set_home(const Vec3& hover_point) { world_.set_home(hover_point); }

 private:
  ClearanceLimits limits_;
  WorldModel world_;
  TeamMembership team_;
  HomeEstimator home_estimator_;
  DecisionCycle cycle_;
  HorizonGuide horizon_;
};

}  // namespace karst::core
