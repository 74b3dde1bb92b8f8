#include "sdk/survey_export/wall_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core_stack/mapping/occupancy/voxel_reader.h"

namespace karst::survey_export {
namespace {

using core::Cell;
using core::CellKey;
using core::Vec3;

/// Half way between where the ray enters the cell and where it leaves it.
double middle_m(const Vec3& from, const Vec3& d, const CellKey& k, double resolution_m) {
  const std::array<std::int32_t, 3> cell{k.x, k.y, k.z};
  double entry = 0, exit = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(d[axis]) < 1e-12) continue;
    const double low = (cell[static_cast<std::size_t>(axis)] * resolution_m - from[axis]) / d[axis];
    const double high = ((cell[static_cast<std::size_t>(axis)] + 1) * resolution_m - from[axis]) / d[axis];
    entry = std::max(entry, std::min(low, high));
    exit = std::min(exit, std::max(low, high));
  }
  return 0.5 * (entry + std::max(entry, exit));
}

}  // namespace

std::optional<double> wall_distance_m(const core::VoxelMap& map, const Vec3& from, const Vec3& d) {
  core::VoxelReader reader(map);
  bool in_gap = false;
  std::optional<CellKey> wall;
  core::traverse(from, from + kMostWall_m * d, map.resolution_m(), [&](const CellKey& k) {
    const Cell c = reader.at(k);
    if (c == Cell::occupied) {
      wall = k;
      return false;
    }
    if (c == Cell::unknown && in_gap) return false;
    in_gap = c == Cell::unknown;
    return true;
  });
  if (!wall) return std::nullopt;
  return middle_m(from, d, *wall, map.resolution_m());
}

survey::Dimensions dimensions_at(const core::VoxelMap& map, const Vec3& station, const Vec3& facing) {
  const Vec3 left(-facing.y(), facing.x(), 0);
  return {wall_distance_m(map, station, left), wall_distance_m(map, station, -left),
          wall_distance_m(map, station, Vec3::UnitZ()), wall_distance_m(map, station, -Vec3::UnitZ())};
}

}  // namespace karst::survey_export
