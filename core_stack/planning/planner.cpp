#include "core_stack/planning/planner.h"

#include <cstdio>

#include "core_stack/planning/grid_planner.h"
#include "core_stack/planning/refine.h"

namespace karst::core {
namespace {

/// Straight distance up to which the grid search comes first.
constexpr double kNear_m = 30.0;

/// A start that lies in the slack below the clearance must have left it after this much of the path.
constexpr double kSlackLeft_m = 1.0;

/// Refines `raw` and looks at every segment once more.
Path finished(const VoxelMap& map, const Path& raw, const PlanningOptions& options) {
  const double search_m = search_clearance_m(options, map.resolution_m());
  Path path = raw;
  path.points = refine_path(map, raw.points, options);
  path.length_m = path_length_m(path.points);
  double since_escape_m = 0;
  for (std::size_t i = raw.escape_points; i + 1 < path.points.size(); ++i) {
    const Vec3 &a = path.points[i], &b = path.points[i + 1];
    if (segment_clear(map, a, b, options.clearance_m)) {
      since_escape_m = kSlackLeft_m;
      continue;
    }
    since_escape_m += (b - a).norm();
    if (since_escape_m <= kSlackLeft_m && segment_clear(map, a, b, search_m)) {
      path.escape_points = i + 1;
      continue;
    }
    char text[160];
    std::snprintf(text, sizeof text,
                  "the passage at (%.1f, %.1f, %.1f) is narrower than twice the clearance of %.2f m", a.x(),
                  a.y(), a.z(), options.clearance_m);
    path = Path{};
    path.reason = text;
    break;
  }
  return path;
}

}  // namespace

Path plan(const VoxelMap& map, const Roadmap& roadmap, const Vec3& start, const Vec3& goal,
          const PlanningOptions& options) {
  if (!is_clear(map, goal, options.clearance_m)) return plan_on_grid(map, start, goal, options);  // says why
  PlanningOptions search = options;
  search.clearance_m = search_clearance_m(options, map.resolution_m());
  Path raw;
  raw.status = PlanStatus::gave_up;
  if ((goal - start).norm() <= kNear_m) raw = plan_on_grid(map, start, goal, search);
  if (raw.status == PlanStatus::gave_up) raw = roadmap.find(map, start, goal);
  if (!raw.found()) return raw;
  Path path = finished(map, raw, options);
  if (path.found()) return path;
  const Path strict = plan_on_grid(map, start, goal, options);
  return strict.found() ? finished(map, strict, options) : path;
}

}  // namespace karst::core
