#include "sdk/cave_from_cloud/occupied_cells.h"

#include <cmath>

#include "core_stack/mapping/occupancy/cell_walk.h"

namespace karst::from_cloud {

using core::Vec3;

OccupiedCells::OccupiedCells(const std::vector<core::Vec3f>& points, double cell_m) : cell_m_(cell_m) {
  for (const core::Vec3f& p : points) {
    const Vec3 cell = p.cast<double>() / cell_m;
    const auto key = [&](int axis) { return static_cast<std::int32_t>(std::floor(cell[axis])); };
    cells_.insert(core::pack({key(0), key(1), key(2)}));
  }
}

bool OccupiedCells::block(const Vec3& from, const Vec3& to) const {
  bool met = false;
  core::walk_cells(from / cell_m_, to / cell_m_, [&](core::PackedCell cell) {
    met = cells_.contains(cell);
    return !met;
  });
  return met;
}

}  // namespace karst::from_cloud
