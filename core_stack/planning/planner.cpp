#include "core_stack/planning/planner.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core_stack/planning/path/refine.h"
#include "core_stack/planning/roadmap/roadmap_graph.h"
#include "core_stack/planning/search/grid_planner.h"
#include "core_stack/planning/search/ompl_search.h"

namespace karst::core {
namespace {

/// Straight-line distance up to which the grid search comes first, and its limit of expansions: a goal behind
/// a wall may be near only in a straight line.
constexpr double kNear_m = 12.0;
constexpr std::int64_t kNearExpansions = 30000;

/// A start with less than the full clearance must reach full clearance within this length of path.
constexpr double kSlackLeft_m = 1.0;
/// A place where refining failed is replanned from this far before it to this far behind, so many times.
constexpr double kDetourRadius_m = 2.0;
constexpr int kMaxDetours = 6;

/// Refines `raw` with the roadmap's free cells, which equal the map's: nothing is read again.
Path refined(const VoxelMap& map, const Roadmap& roadmap, const Path& raw, const PlanningOptions& options) {
  Path path = raw;
  const RoadmapGraph& graph = roadmap.graph();
  path.points =
      graph.rule ? refine_path(graph.free, raw.points, options) : refine_path(map, raw.points, options);
  if (raw.length_m > 0) measure(path, raw.length_bound * path_length_m(path.points) / raw.length_m);
  return path;
}

/// Index of the first segment that is not clear, or -1. Accepts the escape and the reduced clearance around
/// the start; both then count as escape points.
int first_flaw(const VoxelMap& map, Path& path, const PlanningOptions& options) {
  const double search_m = search_clearance_m(options, map.resolution_m());
  double slack_left_m = kSlackLeft_m;
  for (std::size_t i = path.escape_points; i + 1 < path.points.size(); ++i) {
    const Vec3 &a = path.points[i], &b = path.points[i + 1];
    if (segment_clear(map, a, b, options.clearance_m)) {
      slack_left_m = 0;
      continue;
    }
    slack_left_m -= (b - a).norm();
    if (slack_left_m < 0 || !segment_clear(map, a, b, search_m)) return static_cast<int>(i);
    path.escape_points = i + 1;
  }
  return -1;
}

/// Replaces the part around segment `flaw` by a path of full clearance; false if there is none nearby.
bool detour(const VoxelMap& map, Path& path, std::size_t flaw, const PlanningOptions& options) {
  std::size_t from = flaw, to = flaw + 1;
  const Vec3 place = path.points[flaw];
  const auto good_end = [&](const Vec3& p) {
    return (p - place).norm() >= kDetourRadius_m && is_clear(map, p, options.clearance_m);
  };
  while (from > path.escape_points && !good_end(path.points[from])) --from;
  while (to + 1 < path.points.size() && !good_end(path.points[to])) ++to;
  PlanningOptions local = options;
  local.max_expansions = std::min(options.max_expansions, kNearExpansions);
  const Path bypass = plan_on_grid(map, path.points[from], path.points[to], local);
  if (!bypass.found() || (bypass.escape_points > 0 && from > path.escape_points)) return false;
  std::vector<Vec3> points(path.points.begin(), path.points.begin() + static_cast<std::ptrdiff_t>(from));
  points.insert(points.end(), bypass.points.begin(), bypass.points.end());
  points.insert(points.end(), path.points.begin() + static_cast<std::ptrdiff_t>(to) + 1, path.points.end());
  path.points = std::move(points);
  measure(path, std::numeric_limits<double>::infinity());
  return true;
}

/// Refines `raw` until every segment is clear; replans where the passage turns out too narrow.
Path finished(const VoxelMap& map, const Roadmap& roadmap, const Path& raw, const PlanningOptions& options) {
  Path path = refined(map, roadmap, raw, options);
  for (int round = 0;; ++round) {
    const int flaw = first_flaw(map, path, options);
    if (flaw < 0) {
      path.clear_by_m = options.clearance_m;
      return path;
    }
    const Vec3 p = path.points[static_cast<std::size_t>(flaw)];
    path.escape_points = raw.escape_points;
    if (round < kMaxDetours && detour(map, path, static_cast<std::size_t>(flaw), options)) {
      path = refined(map, roadmap, path, options);
      continue;
    }
    char text[160];
    std::snprintf(text, sizeof text,
                  "the passage at (%.1f, %.1f, %.1f) is narrower than twice the clearance of %.2f m", p.x(),
                  p.y(), p.z(), options.clearance_m);
    path = Path{};
    path.reason = text;
    return path;
  }
}

/// The search with reduced clearance: a cell is usable if some point beside its centre is clear.
Path searched(const VoxelMap& map, const Roadmap& roadmap, const Vec3& start, const Vec3& goal,
              const PlanningOptions& options) {
  if (options.planner != Planner::grid)
    return search_with_ompl(map, roadmap, start, goal, options,
                            search_clearance_m(options, map.resolution_m()));
  PlanningOptions near = options;
  near.max_expansions = std::min(options.max_expansions, kNearExpansions);
  Path raw;
  raw.status = PlanStatus::gave_up;
  if ((goal - start).norm() <= kNear_m) raw = plan_on_grid_squeezing(map, start, goal, near);
  return raw.status == PlanStatus::gave_up ? roadmap.find(map, start, goal) : raw;
}

/// The search with full clearance.
Path searched_wide(const VoxelMap& map, const Roadmap& roadmap, const Vec3& start, const Vec3& goal,
                   const PlanningOptions& options) {
  if (options.planner == Planner::grid) return plan_on_grid(map, start, goal, options);
  return search_with_ompl(map, roadmap, start, goal, options, options.clearance_m);
}

}  // namespace

Path plan_along(const VoxelMap& map, const Roadmap& roadmap, const Path& raw,
                const PlanningOptions& options) {
  Path path = finished(map, roadmap, raw, options);
  if (path.found()) return path;
  const Path wide = searched_wide(map, roadmap, raw.points.front(), raw.points.back(), options);
  if (wide.found()) {
    Path around = finished(map, roadmap, wide, options);
    if (around.found()) return around;
  }
  // A narrow passage without a path around it: keep the clearance that the search found.
  PlanningOptions tight = options;
  tight.clearance_m = min_clearance_m(options, map.resolution_m());
  Path narrow = finished(map, roadmap, raw, tight);
  if (!narrow.found()) return path;
  mark_narrow_places(map, options.clearance_m, narrow);
  return narrow;
}

void mark_narrow_places(const VoxelMap& map, double clearance_m, Path& path) {
  constexpr double kSpacing_m = 0.5;
  std::vector<Vec3>& places = path.narrow_places;
  places.clear();
  for (std::size_t i = path.escape_points; i + 1 < path.points.size(); ++i) {
    const Vec3 from = path.points[i], along = path.points[i + 1] - from;
    const int pieces = std::max(1, static_cast<int>(std::ceil(along.norm() / kSpacing_m)));
    for (int k = 0; k < pieces; ++k) {
      const Vec3 a = from + along * k / pieces, b = from + along * (k + 1) / pieces;
      if (!segment_clear(map, a, b, clearance_m) &&
          (places.empty() || (places.back() - a).norm() >= kSpacing_m))
        places.push_back(a);
    }
  }
}

Path plan(const VoxelMap& map, const Roadmap& roadmap, const Vec3& start, const Vec3& goal,
          const PlanningOptions& options) {
  if (!is_clear(map, goal, options.clearance_m)) return plan_on_grid(map, start, goal, options);  // says why
  const Path raw = searched(map, roadmap, start, goal, options);
  return raw.found() ? plan_along(map, roadmap, raw, options) : raw;
}

}  // namespace karst::core
