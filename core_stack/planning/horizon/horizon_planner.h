// Receding-horizon motion: position and heading of the next three seconds together, to where the vehicle is
// going by way of what its sensors will see.
//
// Candidates are sequences of legs (rollout.h). Each is followed by a stop, and is dropped unless every bit
// of it, the stop included, is clear in the map. The value of a candidate in seconds is
//
//   worth_s_per_m3 * what it sees  -  time left to the goal from where it ends.
//
// The best candidates are varied, with less spread each time (the cross-entropy method; Rubinstein, 1999).
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core_stack/planning/horizon/rollout.h"
#include "core_stack/planning/horizon/view_gain.h"
#include "core_stack/planning/roadmap/distance_tree.h"

namespace karst::core {

struct HorizonGoal {
  Vec3 position = Vec3::Zero();
  double heading_rad = std::numeric_limits<double>::quiet_NaN();  // NaN: any
};

struct HorizonQuery {
  MotionState start;
  std::vector<TrajectorySample> under_way;  // the trajectory as it is, from the start on, every 100 ms
  std::optional<Legs> last;                 // of the last plan, moved on to the start
  HorizonGoal goal;
  bool turns = true;  // to what it passes; or else it faces as the goal asks
  MotionLimits limits;
  double braking_mps2 = 1;
  double clearance_m = 0.6;
  double steepest_rad = 1.5;    // climbs and descents
  double worth_s_per_m3 = 0.1;  // 0: fly to the goal as fast as possible
  std::uint64_t seed = 1;
};

struct HorizonPlan {
  MotionState start;
  std::vector<TrajectorySample> samples;  // from the start to rest, every 100 ms
  Legs legs;
  double time_left_s = 0;  // to the goal, from the start, by way of this plan
};

/// `to_goal`: rooted at the goal and up to date. Nothing if no candidate is better than what is under way.
std::optional<HorizonPlan> plan_horizon(const VoxelMap& map, const Roadmap& roadmap,
                                        const DistanceTree& to_goal, const std::vector<ViewRay>& rays,
                                        const HorizonQuery& query);

}  // namespace karst::core
