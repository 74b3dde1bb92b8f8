// The free space of a map as vertical runs of cells: for each column of cells, where it is free. Two runs of
// a column have a storey of rock between them.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::cave_drawing {

struct Run {
  std::int32_t low = 0, high = 0;  // its lowest and its highest cell
  bool touches(const Run& other) const { return low <= other.high && other.low <= high; }
};

struct Column {
  std::int32_t x = 0, y = 0;
  std::vector<Run> runs;  // from below
};

struct FreeRuns {
  double cell_m = 0.2;
  std::vector<Column> columns;  // by y, then by x; each has a run
  std::int32_t low_x = 0, low_y = 0, low_z = 0, high_x = 0, high_y = 0, high_z = 0;

  /// Of the columns; nullptr if the column has no run.
  const Column* find(std::int32_t x, std::int32_t y) const;
};

/// The largest connected part of the free cells. Less than half a metre that is not free does not part two
/// runs: boulders and gaps between rays are no storeys. Throws core::InputError that names `file` if no cell
/// is free.
FreeRuns free_runs(const core::VoxelMap& map, const std::string& file);

}  // namespace karst::cave_drawing
