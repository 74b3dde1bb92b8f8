#include "core_stack/planning/passages/cross_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core_stack/mapping/occupancy/voxel_reader.h"

namespace karst::core {
namespace {

/// Where the line enters the cell, in units of `d` from `from`.
double entry_m(const Vec3& from, const Vec3& d, const CellKey& k, double resolution_m) {
  const std::array<std::int32_t, 3> cell{k.x, k.y, k.z};
  double entry = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(d[axis]) < 1e-12) continue;
    const double border = (cell[static_cast<std::size_t>(axis)] + (d[axis] > 0 ? 0 : 1)) * resolution_m;
    entry = std::max(entry, (border - from[axis]) / d[axis]);
  }
  return entry;
}

struct Line {
  Vec3 direction = Vec3::Zero();
  double ahead_m = 0, behind_m = 0;
  double length_m() const { return ahead_m + behind_m; }
  /// From where it was measured to its middle, by `most_m` at most.
  Vec3 to_middle(double most_m) const {
    return std::clamp(0.5 * (ahead_m - behind_m), -most_m, most_m) * direction;
  }
};

Line measured_line(const VoxelMap& map, const Vec3& from, const Vec3& d) {
  return {d, free_reach_m(map, from, d), free_reach_m(map, from, -d)};
}

Line narrowest_line(const VoxelMap& map, const Vec3& from) {
  constexpr int kLines = 10;
  Line narrowest;
  for (int i = 0; i < kLines; ++i) {
    const double a = i * std::numbers::pi / kLines;
    const Line line = measured_line(map, from, {std::cos(a), std::sin(a), 0});
    if (i == 0 || line.length_m() < narrowest.length_m() - 1e-9) narrowest = line;
  }
  return narrowest;
}

}  // namespace

double free_reach_m(const VoxelMap& map, const Vec3& from, const Vec3& d) {
  VoxelReader reader(map);
  std::optional<CellKey> gap, end;
  traverse(from, from + kMostReach_m * d, map.resolution_m(), [&](const CellKey& k) {
    const Cell c = reader.at(k);
    if (c == Cell::free) {
      gap.reset();
      return true;
    }
    if (c == Cell::unknown && !gap) {
      gap = k;
      return true;
    }
    end = gap ? *gap : k;
    return false;
  });
  if (!end) end = gap;
  return end ? std::min(kMostReach_m, entry_m(from, d, *end, map.resolution_m())) : kMostReach_m;
}

CrossSection cross_section(const VoxelMap& map, const Vec3& from, double most_m) {
  CrossSection out;
  out.center = from + narrowest_line(map, from).to_middle(most_m);
  out.center += measured_line(map, out.center, Vec3::UnitZ()).to_middle(most_m);
  out.width_m = narrowest_line(map, out.center).length_m();
  out.height_m = measured_line(map, out.center, Vec3::UnitZ()).length_m();
  return out;
}

}  // namespace karst::core
