#include "core_stack/planning/path/path.h"

#include <algorithm>

namespace karst::core {

void describe(OptionTable& t, PlanningOptions& o) {
  t.add("clearance", o.clearance_m, "m", 0.1, 3.0,
        "least distance of a path from the centres of occupied cells and of the unknown's border");
  t.add("preferred_clearance", o.preferred_clearance_m, "m", 0.1, 5.0,
        "paths are pushed out to this distance where there is room");
  t.add("narrow_margin", o.narrow_margin_m, "m", 0, 1,
        "where nothing else is left to explore, passages are flown, slowly, that leave this much between the "
        "vehicle's "
        "radius and the centres of occupied cells; 0: never");
  t.add("heuristic_weight", o.heuristic_weight, "", 1.0, 5.0,
        "the grid search's path is at most this times longer than the shortest on the grid");
  t.add("max_expansions", o.max_expansions, 1000, 1e8, "the grid search gives up after so many cells");
  t.add("planner", o.planner,
        "what searches for paths: ours on the grid and the roadmap, or one of OMPL's planners");
  t.add(
      "planner_iterations", o.planner_iterations, 100, 1e6,
      "OMPL's planners stop after so many iterations (BIT*: ten edges each); RRT-Connect at its first path");
}

bool near_narrow_place(const std::vector<Vec3>& places, const Vec3& a, const Vec3& b) {
  return std::any_of(places.begin(), places.end(), [&](const Vec3& p) {
    const Vec3 along = b - a;
    const double l2 = along.squaredNorm();
    const double s = l2 > 0 ? std::clamp((p - a).dot(along) / l2, 0.0, 1.0) : 0.0;
    return (a + s * along - p).norm() <= kNarrowRadius_m;
  });
}

double path_length_m(const std::vector<Vec3>& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

void measure(Path& path, double promised_bound) {
  path.length_m = path_length_m(path.points);
  path.length_bound = promised_bound;
  const double straight_m = (path.points.back() - path.points.front()).norm();
  if (straight_m > 0) path.length_bound = std::min(promised_bound, path.length_m / straight_m);
}

}  // namespace karst::core
