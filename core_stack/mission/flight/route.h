// Turns a path into a flyable route: joined to the current trajectory, and timed.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mission/flight/flight.h"
#include "core_stack/mission/policy/policy_port.h"
#include "core_stack/planning/trajectory/polynomial_trajectory.h"

namespace karst::core {

/// Where and how a new path joins the current trajectory. Created on the loop's thread, used on the map lane.
struct RouteStart {
  TimeNs at = 0;                       // time from which it will be followed
  Flight::CommittedSegment committed;  // the path begins at its end
  MotionLimits limits;                 // as they are now
  std::vector<Vec3> narrow_places;     // that the committed segment may pass through
  double max_cut_m = 0.3;              // maximum corner deviation of the join
  std::optional<Goal> passed = {};     // the goal at the committed segment's end, if any
};

/// A path that is ready to be flown.
struct Route {
  Path path;
  std::vector<Vec3> points;  // the committed segment, then the path
  HeadingPlan heading;
  double start_speed_mps = 0, max_speed_mps = 0;
  SlowPlaces slow;
  std::optional<PolynomialTrajectory> polynomial;  // along the points, if the mission flies polynomials
  Trajectory sampled;                              // along the points, within `limits`; its start is not set
  MotionLimits limits;
};

/// Joins `path` to the start. `goal` is the policy's goal at the end of the path, if any.
Route make_route(const VoxelMap& map, const CoreOptions& options, const VehicleDescription& vehicle,
                 const RouteStart& start, const Path& path, const std::optional<Goal>& goal);

}  // namespace karst::core
