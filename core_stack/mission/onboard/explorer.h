// Everything that works on the map: it takes in rays, decides where to explore next, and plans.
//
// An Explorer lives on the map lane of the executive: all its calls run there one after another, so the map
// needs no lock and a decision sees the map as it was when the decision began. It owns the parts that do the
// work, and passes each call on to the part that answers it.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mission/decision/cycle.h"
#include "core_stack/mission/decision/decision_cycle.h"
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
  /// `policy` outlives it.
  Explorer(const CoreOptions& options, const VehicleDescription& vehicle, PolicyPort& policy);
  Explorer(const Explorer&) = delete;  // its parts refer to each other
  Explorer& operator=(const Explorer&) = delete;

  /// Takes one sensor's rays into the map; returns what changed.
  std::vector<CellChange> integrate(const std::vector<Ray>& rays);
  std::vector<CellChange> declare_launch_site(const Vec3& hover_point);

  /// A picture was taken from there, by the vehicle's colour camera.
  void note_picture(const Pose& T_world_camera);

  CycleResult decide(const CycleInput& input);
  /// A path from `from` to `to` for going home or around a new obstacle.
  Path plan_to(const Vec3& from, const Vec3& to);
  /// Through the map, or if no path is known there, `flown_length_m` long.
  HomeEstimate estimate_home(const Vec3& from, double flown_length_m);
  /// Back along poses flown, from the last to the first and home, leaving out loops where the map shows a
  /// clear line.
  std::vector<Vec3> path_back(const std::vector<Vec3>& flown) const;
  /// What happened to its goals, and that it is over.
  void tell(const std::vector<PolicyEvent>& events, TimeNs now);
  /// Index of the first segment of `points` nearer to an obstacle's cell than the vehicle's radius, or -1.
  int touching_segment(const std::vector<Vec3>& points) const;
  /// Index of the first segment of `points` that the map now forbids, or -1. Near the `narrow_places` of the
  /// path it allows for less clearance.
  int blocked_segment(const std::vector<Vec3>& points, const std::vector<Vec3>& narrow_places) const;
  /// Distance of the vehicle's hull at `p` from the nearest obstacle's cell; nothing if that is far.
  std::optional<double> hull_clearance_m(const Vec3& p) const;
  /// Where to hover between the place it stood at and `highest`, straight above: as high as the usual
  /// clearance allows, or with the most room above and below where there is not so much.
  Vec3 hover_below(const Vec3& highest) const;
  /// True if the cluster is still open enough to be worth flying to.
  bool cluster_alive(std::uint32_t id) const;

  // In a team.
  void join(RelayHoming* homing, double claim_radius_m);
  /// Takes in what was heard; returns what to report.
  TreeFacts share(const Vec3& here, const TeamNews& news);
  /// See RelayHoming::relay_drop_site.
  std::optional<Vec3> relay_drop_site(const Release& here, const Release& ahead) const;
  /// Where to land as a relay, if that takes less time than the path to the start.
  std::optional<LandingSpot> landing_spot(const Vec3& from, double flown_length_m);
  /// It landed below `hover`: what to report.
  TreeFacts land(const Vec3& hover, TimeNs team_time);
  /// Where it makes room for another vehicle; the vehicle's radius is filled in.
  std::optional<WaitingPlace> find_waiting_place(RoomQuery query);

  const VoxelMap& map() const { return world_.map(); }
  const Vec3& home() const { return world_.home(); }
  /// Where the vehicle came to hover, if take-off had to stop lower than planned.
  void set_home(const Vec3& hover_point) { world_.set_home(hover_point); }

 private:
  ClearanceLimits limits_;
  WorldModel world_;
  TeamMembership team_;
  HomeEstimator home_estimator_;
  DecisionCycle cycle_;
};

}  // namespace karst::core
