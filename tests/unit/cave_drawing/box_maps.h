// Maps of boxes of cells for the tests of drawings: free inside, rock around.
#pragma once
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::test {

struct CellBox {
  core::CellKey low, high;  // closed
};

/// The boxes are free, and a layer of rock, two cells thick, is around them.
inline core::VoxelMap map_of_boxes(const std::vector<CellBox>& boxes) {
  core::VoxelMap map{core::MapOptions{}};
  const auto fill = [&](const CellBox& b, int around, float log_odds) {
    for (int z = b.low.z - around; z <= b.high.z + around; ++z)
      for (int y = b.low.y - around; y <= b.high.y + around; ++y)
        for (int x = b.low.x - around; x <= b.high.x + around; ++x) map.assign({x, y, z}, 1, log_odds);
  };
  for (const CellBox& b : boxes) fill(b, 2, 2.0f);
  for (const CellBox& b : boxes) fill(b, 0, -2.0f);
  return map;
}

}  // namespace karst::test
