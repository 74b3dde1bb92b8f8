// The way home along the known map, and how long it takes: asked every second of a flight, so that the
// vehicle turns back in time.
#pragma once
#include "core_stack/mapping/voxel_map.h"
#include "core_stack/planning/roadmap.h"
#include "core_stack/planning/trajectory.h"

namespace karst::core {

struct HomePlan {
  bool found = false;
  double length_m = 0;  // of `points`
  std::vector<Vec3>
      points;          // from the position to home; raw: for estimates and drawing, plan() before flying it
  std::string reason;  // when not found
};

/// One search on the roadmap.
HomePlan plan_home(const VoxelMap& map, const Roadmap& roadmap, const Vec3& position, const Vec3& home,
                   const PlanningOptions& options);

/// Time to fly `length_m` home from rest to rest and to descend there from home_z_m to ground_z_m. The speed
/// held on the way is taken as a share of the greatest that caves with bends allow.
double home_time_s(double length_m, double ground_z_m, double home_z_m, const MotionLimits& limits,
                   double landing_speed_mps);

/// Seconds left before the vehicle must turn back: what the battery lasts, less the way home with `margin` (a
/// share of its time) and a fixed reserve. Negative: too late.
double home_slack_s(double battery_seconds_left, double home_time_s, double margin, double reserve_s);

}  // namespace karst::core
