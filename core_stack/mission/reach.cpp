#include "core_stack/mission/reach.h"

namespace karst::core {

void Reach::update(const VoxelMap& map, const Vec3& home) {
  roadmap.update(map, due);
  due.clear();
  way_home.update(map, roadmap, home, planning);
}

std::optional<double> narrow_clearance_m(const PlanningOptions& options, double vehicle_radius_m) {
  const double clearance_m = vehicle_radius_m + options.narrow_margin_m;
  if (options.narrow_margin_m <= 0 || clearance_m >= options.clearance_m) return std::nullopt;
  return clearance_m;
}

Reach narrow_reach(const VoxelMap& map, const PlanningOptions& options, double clearance_m) {
  PlanningOptions narrow = options;
  narrow.clearance_m = clearance_m;
  narrow.search_slack_cells = 0.5;  // the middle of a passage askew to the grid lies off the cells' centres
  Reach reach(narrow);
  map.for_each_known([&](const CellKey& k, Cell cell, float) {
    reach.due.push_back({k, Cell::unknown, cell});
  });
  return reach;
}

}  // namespace karst::core
