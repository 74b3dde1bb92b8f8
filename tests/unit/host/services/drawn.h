// A drawn map as the core's map: two implementations of every service, asked the same.
#pragma once
#include <karst/testing/drawn_host.h>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::test {

inline core::VoxelMap to_core_map(const testing::DrawnMap& drawn) {
  core::VoxelMap map(core::MapOptions{.resolution_m = drawn.resolution_m()});
  for (const auto& [i, cell] : drawn.known())
    map.assign({i.x, i.y, i.z}, 1, cell == Cell::free ? -2.0f : 2.0f);
  return map;
}

/// `side` cubed cells, each drawn by pick() in 0..99.
template <class Pick>
testing::DrawnMap scattered(int side, int free_percent, int occupied_percent, Pick&& pick) {
  std::vector<std::string> layers;
  for (int z = 0; z < side; ++z) {
    std::string layer;
    for (int y = 0; y < side; ++y, layer += '\n')
      for (int x = 0; x < side; ++x) {
        const int p = pick();
        layer += p < free_percent ? '.' : p < free_percent + occupied_percent ? '#' : '?';
      }
    layers.push_back(layer);
  }
  return {0.5, layers};
}

}  // namespace karst::test
