#include "core_stack/mission/world_model/clearance_checks.h"

#include <algorithm>

#include "core_stack/mission/world_model/clearance_roadmap.h"
#include "core_stack/planning/free_space/free_tiles.h"
#include "core_stack/planning/search/grid_planner.h"

namespace karst::core {
namespace {

/// The current path is checked a little more tolerantly than a new one, or noise would stop every flight.
constexpr double kClearanceSlack_m = 0.12;

/// Flown poses within this distance of each other are joined directly if the line has this much clearance
/// beyond the radius.
constexpr double kShortcut_m = 2.0, kShortcutMargin_m = 0.15;

}  // namespace

ClearanceLimits clearance_limits(const PlanningOptions& options, const VehicleDescription& vehicle) {
  return {options.clearance_m, narrow_clearance_m(options, vehicle.radius_m).has_value(), vehicle.radius_m,
          vehicle.T_world_start.position.z()};
}

int touching_segment(const VoxelMap& map, const ClearanceLimits& limits, const std::vector<Vec3>& points) {
  return first_blocked_segment(map, points, limits.hull_radius_m, Confined::no);
}

int blocked_segment(const VoxelMap& map, const ClearanceLimits& limits, const std::vector<Vec3>& points,
                    const std::vector<Vec3>& narrow_places) {
  const double usual_m = limits.usual_m - kClearanceSlack_m;
  const double narrow_m = limits.narrow_passages ? limits.hull_radius_m : usual_m;
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    if (!segment_clear(map, points[i], points[i + 1], usual_m) &&
        !(near_narrow_place(narrow_places, points[i], points[i + 1]) &&
          segment_clear(map, points[i], points[i + 1], narrow_m)))
      return static_cast<int>(i);
  return -1;
}

std::optional<double> hull_clearance_m(const VoxelMap& map, const ClearanceLimits& limits, const Vec3& p,
                                       Confined confined) {
  const double limit_m = limits.hull_radius_m + 0.5;
  FreeTiles free(map.resolution_m(), confined);
  free.load_near(map, p, limit_m);
  const double distance_m = free.nearest(p, limit_m).distance_m - map.resolution_m() / 2;
  if (distance_m >= limit_m - map.resolution_m()) return std::nullopt;
  return distance_m - limits.hull_radius_m;
}

Vec3 hover_below(const VoxelMap& map, const ClearanceLimits& limits, const Vec3& highest) {
  constexpr double kStep_m = 0.05;
  const double enough_m = limits.usual_m - limits.hull_radius_m;
  Vec3 best = highest;
  double max_m = -1;
  for (Vec3 p = highest; max_m < enough_m; p.z() -= kStep_m) {
    const double above_ground_m = p.z() - limits.ground_z_m;
    if (above_ground_m <= max_m) break;
    const double room_m =
        std::min(above_ground_m, hull_clearance_m(map, limits, p, Confined::yes).value_or(above_ground_m));
    if (room_m <= max_m) continue;
    max_m = room_m;
    best = p;
  }
  return best;
}

std::vector<Vec3> flown_back(const VoxelMap& map, const ClearanceLimits& limits,
                             const std::vector<Vec3>& flown) {
  std::vector<Vec3> back;
  const double clearance_m = limits.hull_radius_m + kShortcutMargin_m;
  for (std::size_t i = flown.size(); i-- > 0;) {
    back.push_back(flown[i]);
    // Joining the earliest pose shortens the path most. The segment to the previous pose was itself flown.
    for (std::size_t j = 0; j + 1 < i; ++j)
      if ((flown[j] - flown[i]).norm() < kShortcut_m && segment_clear(map, flown[i], flown[j], clearance_m)) {
        i = j + 1;
        break;
      }
  }
  return back;
}

}  // namespace karst::core
