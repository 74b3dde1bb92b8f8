#include "core_stack/mission/world_model/clearance_roadmap.h"

namespace karst::core {

void ClearanceRoadmap::note(std::span<const CellChange> changes) {
  noted_.insert(noted_.end(), changes.begin(), changes.end());
}

void ClearanceRoadmap::update(const VoxelMap& map, const Vec3& home) {
  roadmap_.update(map, noted_);
  noted_.clear();
  path_home_.update(map, roadmap_, home, planning());
}

std::optional<double> ClearanceRoadmap::home_length_m(const VoxelMap& map, const Vec3& from) const {
  return path_home_.length_m(map, roadmap_, from);
}

Path ClearanceRoadmap::path_home(const VoxelMap& map, const Vec3& from) const {
  return path_home_.find(map, roadmap_, from);
}

std::optional<double> narrow_clearance_m(const PlanningOptions& options, double vehicle_radius_m) {
  const double clearance_m = vehicle_radius_m + options.narrow_margin_m;
  if (options.narrow_margin_m <= 0 || clearance_m >= options.clearance_m) return std::nullopt;
  return clearance_m;
}

ClearanceRoadmap narrow_roadmap(const VoxelMap& map, const PlanningOptions& options, double clearance_m) {
  PlanningOptions narrow = options;
  narrow.clearance_m = clearance_m;
  narrow.search_slack_cells = 0.5;  // the centre line of a passage oblique to the grid misses cell centres
  ClearanceRoadmap roadmap(narrow, Passages::narrow);
  std::vector<CellChange> known;
  map.for_each_known([&](const CellKey& k, Cell cell, float) { known.push_back({k, Cell::unknown, cell}); });
  roadmap.note(known);
  return roadmap;
}

}  // namespace karst::core
