// The interface of an exploration policy, in core types. The host implements it over the ABI; a test
// implements it in five lines.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/localization/state.h"
#include "core_stack/mapping/frontiers/frontiers.h"
#include "core_stack/mapping/frontiers/imaged_surface.h"
#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/mapping/prior/surveyed_passages.h"
#include "core_stack/mission/policy/decision.h"
#include "core_stack/planning/roadmap/roadmap.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

/// A frontier cluster as offered to the policy.
struct FrontierOffer {
  const FrontierCluster* cluster = nullptr;
  Vec3 viewpoint = Vec3::Zero();  // clear, reachable, sees the cluster; NaN if none is found
  double viewpoint_heading_rad = 0;
  double path_length_m = 0;  // from the start of a new path to the viewpoint; +inf if no path is known
};

/// Another vehicle of the team, in its last received state.
struct OtherVehicle {
  std::uint32_t id = 0;  // 1, 2, ...
  TimeNs heard = 0;      // time of this state by this vehicle's clock: negative before its start
  Vec3 position = Vec3::Zero(), velocity_mps = Vec3::Zero();
  std::optional<Vec3> goal;  // its claimed goal
  double seconds_before_homing =
      0;  // estimate; 0: it no longer explores; NaN: no path home from there is known
};

enum class GoalFate { none, under_way, reached, rejected, unreachable, abandoned, superseded };

struct DecisionRequest {
  TimeNs stamp = 0;
  TimeNs deadline = 0;                       // the answer takes effect at this time
  std::uint32_t sequence = 0;                // 1, 2, ...
  State state;                               // expected at the deadline
  Vec3 direction_of_flight = Vec3::UnitX();  // unit, world frame; the heading when at rest
  Pose T_world_start;
  double seconds_before_homing = 0;
  // At `stamp`; 0: not told.
  double battery_fraction = 0;       // of the battery's energy
  double battery_seconds_left = 0;   // at the recent mean power
  double mission_seconds_left = 0;   // of the maximum flight time; +inf: unlimited
  double max_acceleration_mps2 = 2;  // for travel times; a policy does not see it
  double max_speed_mps = 0, clearance_m = 0, vehicle_radius_m = 0;
  GoalFate last_fate = GoalFate::none;
  Vec3 last_goal = Vec3::Zero();
  const VoxelMap* map = nullptr;
  const Roadmap* roadmap = nullptr;
  const ImagedSurface* imaged = nullptr;     // by the colour camera; null without one
  const SurveyedPassages* survey = nullptr;  // known before the flight; null without one
  const VehicleDescription* vehicle = nullptr;
  std::vector<FrontierOffer> frontiers;  // by id
  std::vector<OtherVehicle> teammates;   // by id
};

struct PolicyEvent {
  enum class Kind {
    goal_reached,
    goal_rejected,
    goal_unreachable,
    goal_abandoned,
    goal_superseded,
    homing
  } kind;
  TimeNs stamp = 0;
  Goal goal;
  std::string reason;
};
constexpr auto names_of(PolicyEvent::Kind) {
  using enum PolicyEvent::Kind;
  return std::to_array<Named<PolicyEvent::Kind>>({{goal_reached, "reached"},
                                                  {goal_rejected, "rejected"},
                                                  {goal_unreachable, "unreachable"},
                                                  {goal_abandoned, "abandoned"},
                                                  {goal_superseded, "superseded"},
                                                  {homing, "homing"}});
}

class PolicyPort {
 public:
  virtual ~PolicyPort() = default;
  virtual std::string name() const = 0;
  /// Called on the map lane, never concurrently. Throws PolicyFailure when the policy has failed for good
  /// (hung, returned an error or an invalid answer); mission control then asks the fallback.
  virtual Decision decide(const DecisionRequest& request) = 0;
  virtual void notify(const PolicyEvent& event) = 0;
};

struct PolicyFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace karst::core
