#include "core_stack/mission/flight/route.h"

#include <cmath>

#include "core_stack/mission/flight/trusted_speeds.h"
#include "core_stack/planning/search/grid_planner.h"
#include "core_stack/planning/trajectory/join.h"

namespace karst::core {
namespace {

/// The tracker's limit of speed leaves as much, see with_room_to_catch_up.
constexpr double kMayExceed = 0.05;

bool near_line(const std::vector<Vec3>& line, const Vec3& place) {
  for (std::size_t i = 0; i < line.size(); ++i)
    if (near_narrow_place({place}, line[i], line[std::min(i + 1, line.size() - 1)])) return true;
  return false;
}

}  // namespace

Route make_route(const VoxelMap& map, const CoreOptions& options, const VehicleDescription& vehicle,
                 const RouteStart& start, const Path& path, const std::optional<Goal>& goal) {
  Route out;
  out.path = path;
  const auto clear = [&, usual_m = options.planning.clearance_m](const Vec3& a, const Vec3& b) {
    return segment_clear(map, a, b, usual_m) ||
           (near_narrow_place(path.narrow_places, a, b) && segment_clear(map, a, b, path.clear_by_m));
  };
  const Flight::CommittedSegment& committed = start.committed;
  // A parabola turns back before the committed segment's end, where the vehicle may be too fast still. A bend
  // of that segment itself speaks against no parabola.
  const auto slow_enough = [&](const std::vector<Vec3>& joined, const std::vector<Vec3>& plain) {
    const double greatest_mps = greatest_start_speed_mps(joined, start.limits);
    return greatest_mps >= committed.speed_mps / (1 + kMayExceed) ||
           greatest_mps >= greatest_start_speed_mps(plain, start.limits);
  };
  out.points = join_paths(committed.points, path.points, start.max_cut_m, clear, slow_enough);
  out.heading.along_path = !vehicle.lidar;
  out.heading.start_heading_rad = committed.heading_rad;
  if (goal && std::isfinite(goal->heading_rad)) out.heading.goal_heading_rad = goal->heading_rad;
  // A vehicle with an all-round view sees the passed goal's frontier anyway.
  if (out.heading.along_path && start.passed && std::isfinite(start.passed->heading_rad))
    out.heading.passing = {start.passed->position, start.passed->heading_rad};
  out.start_speed_mps = committed.speed_mps;
  out.max_speed_mps = goal && goal->max_speed_mps > 0 ? goal->max_speed_mps : options.motion.max_speed_mps;
  // The committed segment may still lead through narrow places of the previous path.
  out.slow = {path.narrow_places, kNarrowRadius_m, slow_speed_mps(options)};
  for (const Vec3& place : start.narrow_places)
    if (near_line(committed.points, place)) out.slow.places.push_back(place);
  out.slow.trusted = trusted_speeds(map, options, vehicle, out.points,
                                    kBrakingFraction * start.limits.max_acceleration_mps2);
  if (options.motion.trajectory == TrajectoryKind::polynomial && path.found() && path.escape_points == 0 &&
      out.slow.places.empty()) {
    MotionLimits limits = start.limits;
    limits.max_speed_mps = std::min(limits.max_speed_mps, out.max_speed_mps);
    out.polynomial =
        polynomial_trajectory(out.points, committed.departure, start.at, limits, out.heading, clear);
  }
  out.limits = slowed(start.limits, out.max_speed_mps);
  if (!out.polynomial || !out.polynomial->fell_back.empty())
    out.sampled = sample_trajectory(out.points, out.start_speed_mps, 0, out.limits, out.heading, out.slow);
  return out;
}

}  // namespace karst::core
