// The leaves of an OctoMap file as they are stored. read_octomap makes a VoxelMap of them.
#pragma once
#include <string>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// A cube of known cells with one value.
struct MapLeaf {
  CellKey low;            // the cell at its lowest corner
  std::int32_t edge = 1;  // cells
  float log_odds = 0;
};

struct MapLeaves {
  double resolution_m = 0;
  std::vector<MapLeaf> leaves;
};

/// Reads a .bt or .ot file (its first line says which); throws InputError if it is truncated, damaged or
/// neither. A .bt file holds classes only: its cells get the clamping values of MapOptions' defaults.
MapLeaves read_leaves(const std::string& path);

}  // namespace karst::core
