// The cells a vehicle must keep away from; private to mapping.
#pragma once
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// Occupied cells in the closed box, and unknown cells in it that share a face with a free cell (inside or
/// beside the box). Sorted by block.
std::vector<CellKey> obstacle_cells(const VoxelMap& map, const CellKey& low, const CellKey& high);

}  // namespace karst::core
