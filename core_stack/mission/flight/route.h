// From a path to what is flown: joined to the trajectory under way, and timed.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mission/flight/flight.h"
#include "core_stack/mission/policy/policy_port.h"
#include "core_stack/planning/trajectory/polynomial_trajectory.h"

namespace karst::core {

/// Where and how a new path joins the trajectory under way. Taken on the loop's thread, used on the map lane.
struct RouteStart {
  TimeNs at = 0;                       // it will be followed from then on
  Flight::CommittedSegment committed;  // the stretch the vehicle is committed to; the path begins at its end
  MotionLimits limits;                 // as they are now
  std::vector<Vec3> narrow_places;     // that the lead may pass
  double max_cut_m = 0.3;              // how far the joint may pass by the lead's end
  std::optional<Goal> passed = {};     // the goal that the lead ends at, if any
};

/// A path as it is flown.
struct Route {
  Path path;
  std::vector<Vec3> points;  // the stretch of the trajectory that leads to the path, and the path
  HeadingPlan heading;
  double start_speed_mps = 0, max_speed_mps = 0;
  SlowPlaces slow;
  std::optional<PolynomialTrajectory> polynomial;  // along the points, if the mission flies those
  Trajectory sampled;                              // along the points, within `limits`; its start is not set
  MotionLimits limits;
};

/// Joins `path` to the start. `goal` is the policy's that it leads to, if any.
Route make_route(const VoxelMap& map, const CoreOptions& options, const VehicleDescription& vehicle,
                 const RouteStart& start, const Path& path, const std::optional<Goal>& goal);

}  // namespace karst::core
