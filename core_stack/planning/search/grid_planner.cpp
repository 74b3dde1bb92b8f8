#include "core_stack/planning/search/grid_planner.h"

#include <cstdio>

#include "core_stack/common/format_text.h"
#include "core_stack/mapping/occupancy/voxel_reader.h"
#include "core_stack/mapping/region/flight_region.h"
#include "core_stack/planning/free_space/escape.h"
#include "core_stack/planning/free_space/segment_rows.h"
#include "core_stack/planning/search/grid_search.h"

namespace karst::core {
namespace {

/// False for NaN as well.
bool within_world(const Vec3& p) { return p.cwiseAbs().maxCoeff() < 1e6 && p.allFinite(); }

/// A description such as "occupied cell 0.31 m from the start".
std::string what_blocks(const VoxelMap& map, const FreeTiles& free, const Vec3& p, double clearance_m,
                        const char* place) {
  if (!within_world(p)) return std::string("the ") + place + " lies nowhere near the map";
  const auto class_name = [](Cell c) { return c == Cell::occupied ? "occupied" : "unknown"; };
  if (map.at(p) != Cell::free)
    return std::string("the ") + place + " lies in an " + class_name(map.at(p)) + " cell";
  if (!map.may_fly(map.key_of(p)))
    return std::string("the ") + place + " lies outside " + map.region()->nearest_part(p) + " and its margin";
  const NearestObstacle o = free.nearest(p, clearance_m);
  if (map.at(o.center) == Cell::free)
    return format_text("%s is %.2f m from the %s, less than the clearance of %.2f m",
                       map.region()->nearest_part(o.center).c_str(), o.distance_m, place, clearance_m);
  char text[160];
  std::snprintf(text, sizeof text, "%s cell %.2f m from the %s, less than the clearance of %.2f m",
                class_name(map.at(o.center)), o.distance_m, place, clearance_m);
  return text;
}

/// Clear cells next to p that a clear segment connects to p.
std::vector<CellKey> cells_that_see(const FreeTiles& free, const Vec3& p, double clearance_m) {
  std::vector<CellKey> out;
  const CellKey k = free.key_of(p);
  for (int i = 0; i < 27; ++i) {
    const CellKey n = k + CellKey{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
    if (free.segment_clear(p, free.center_of(n), clearance_m)) out.push_back(n);
  }
  return out;
}

/// `clearance` is required of the points and segments of the path.
Path search_path(const VoxelMap& map, const Vec3& start, const Vec3& goal, const PlanningOptions& options,
                 const ClearanceRule& rule, double clearance) {
  const double res = map.resolution_m();
  FreeTiles free(res);
  Path path;
  const auto fail = [&path](PlanStatus status, std::string reason) {
    path.points.clear();
    path.status = status;
    path.reason = std::move(reason);
    return path;
  };
  for (const Vec3& p : {start, goal})
    if (within_world(p)) free.load_near(map, p, 2 * clearance + 2 * res);
  if (!free.is_clear(goal, clearance))
    return fail(PlanStatus::goal_blocked, what_blocks(map, free, goal, clearance, "goal"));

  path.points = {start};
  if (!free.is_clear(start, clearance)) {
    const auto escape = within_world(start) ? escape_path(map, free, start, clearance) : std::nullopt;
    if (!escape)
      return fail(PlanStatus::start_blocked,
                  what_blocks(map, free, start, clearance, "start") +
                      ", and no way out of there that only leads away from obstacles");
    path.points = *escape;
    path.escape_points = escape->size() - 1;
  }
  const Vec3 from = path.points.back(), half = Vec3::Constant(0.5);
  const GridSearchResult found = search_grid(map, free, rule,
                                             {.starts = cells_that_see(free, from, clearance),
                                              .goals = cells_that_see(free, goal, clearance),
                                              .from = from / res - half,
                                              .to = goal / res - half,
                                              .weight = options.heuristic_weight,
                                              .max_expansions = options.max_expansions});
  if (found.end == GridSearchResult::End::gave_up)
    return fail(PlanStatus::gave_up, "gave up after " + std::to_string(options.max_expansions) + " cells");
  if (found.end == GridSearchResult::End::exhausted)
    return fail(PlanStatus::no_path,
                "no way of the clearance asked leads through known free space to the goal (" +
                    std::to_string(found.expansions) + " cells reached)");
  for (const CellKey& k : found.cells)
    if (const Vec3 p = map.center_of(k); (p - path.points.back()).norm() > 1e-9) path.points.push_back(p);
  if (path.points.size() < 2 || (goal - path.points.back()).norm() > 1e-9) path.points.push_back(goal);
  path.status = PlanStatus::found;
  // The suboptimality bound does not cover the escape from a tight place.
  measure(path, path.escape_points == 0 ? options.heuristic_weight : std::numeric_limits<double>::infinity());
  return path;
}

}  // namespace

Path plan_on_grid(const VoxelMap& map, const Vec3& start, const Vec3& goal, const PlanningOptions& options) {
  return search_path(map, start, goal, options, ClearanceRule(options.clearance_m / map.resolution_m()),
                     options.clearance_m);
}

Path plan_on_grid_squeezing(const VoxelMap& map, const Vec3& start, const Vec3& goal,
                            const PlanningOptions& options) {
  const double res = map.resolution_m(), search_m = search_clearance_m(options, res);
  return search_path(map, start, goal, options, ClearanceRule(options.clearance_m / res, search_m / res),
                     search_m);
}

bool segment_clear(const VoxelMap& map, const Vec3& a, const Vec3& b, double clearance_m, Confined confined) {
  if (!within_world(a) || !within_world(b)) return false;
  const double res = map.resolution_m();
  const Vec3 half = Vec3::Constant(0.5);
  // Near the region's border each cell is asked: the depth changes by no more than the distance.
  const double reach_m = (b - a).norm() / 2 + clearance_m + res;
  const bool at_border = confined == Confined::yes && map.region() &&
                         !(map.region()->depth_m((a + b) / 2) >= map.region()->limits().margin_m + reach_m);
  VoxelReader reader(map);
  const auto free = [&](const CellKey& k) { return at_border ? map.may_fly(k) : reader.at(k) == Cell::free; };
  const bool near_free =
      all_rows_near_segment(a / res - half, b / res - half, clearance_m / res,
                            [&free](std::int32_t x_low, std::int32_t x_high, std::int32_t y, std::int32_t z) {
                              for (std::int32_t x = x_low; x <= x_high; ++x)
                                if (!free(CellKey{x, y, z})) return false;
                              return true;
                            });
  if (!near_free || clearance_m > 0.87 * res) return near_free;
  if (map.first_not_free(a, b)) return false;
  bool passed_free = true;
  if (at_border) traverse(a, b, res, [&](const CellKey& k) { return passed_free = free(k); });
  return passed_free;
}

bool is_clear(const VoxelMap& map, const Vec3& p, double clearance_m) {
  return segment_clear(map, p, p, clearance_m);
}

int first_blocked_segment(const VoxelMap& map, const std::vector<Vec3>& points, double clearance_m,
                          Confined confined) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    if (!segment_clear(map, points[i], points[i + 1], clearance_m, confined)) return static_cast<int>(i);
  return -1;
}

}  // namespace karst::core
