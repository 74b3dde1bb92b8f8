// The way home along the known map, and how long it takes: asked every second of a flight, so that the
// vehicle turns back in time.
#pragma once
#include <optional>

#include "core_stack/mapping/voxel_map.h"
#include "core_stack/planning/roadmap.h"
#include "core_stack/planning/trajectory.h"

namespace karst::core {

/// Length of the shortest way home through the roadmap; nothing if none is known.
std::optional<double> way_home_m(const VoxelMap& map, const Roadmap& roadmap, const Vec3& position,
                                 const Vec3& home, const PlanningOptions& options);

/// Time to fly `length_m` from rest to rest. The speed held on the way is taken as a share of the greatest
/// that caves with bends allow.
double flight_time_s(double length_m, const MotionLimits& limits);

/// Time to fly `length_m` home and to descend there from home_z_m to ground_z_m.
double home_time_s(double length_m, double ground_z_m, double home_z_m, const MotionLimits& limits,
                   double landing_speed_mps);

/// Seconds left before the vehicle must turn back: the time left, less the way home with `margin` (a share of
/// its time) and a fixed reserve. Negative: too late.
double home_slack_s(double seconds_left, double home_time_s, double margin, double reserve_s);

}  // namespace karst::core
