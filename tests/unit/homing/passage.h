// A passage drawn into a map.
#pragma once
#include <cmath>
#include <vector>

#include "tests/unit/planning/test_maps.h"

namespace karst::core::testing {

/// A passage along x with a floor at z = 0, free inside.
inline VoxelMap passage(double width_m, double height_m, double length_m = 20,
                        std::vector<CellChange>* changes = nullptr) {
  VoxelMap map{MapOptions{}};
  const int w = static_cast<int>(std::lround(width_m / 0.4)),
            h = static_cast<int>(std::lround(height_m / 0.2)),
            l = static_cast<int>(std::lround(length_m / 0.4));
  draw(
      map, {-l - 2, -w - 2, -2}, {l + 2, w + 2, h + 2},
      [&](const CellKey& k) {
        return std::abs(k.x) < l && k.y >= -w && k.y < w && k.z >= 0 && k.z < h ? Cell::free : Cell::occupied;
      },
      changes);
  return map;
}

}  // namespace karst::core::testing
