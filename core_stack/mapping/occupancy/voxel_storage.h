// Storage of VoxelMap; private to mapping.
#pragma once
#include <memory>

#include "core_stack/mapping/occupancy/scan_marks.h"
#include "core_stack/mapping/occupancy/voxel_blocks.h"

namespace karst::core {

struct VoxelMap::Storage {
  explicit Storage(const MapOptions& o);

  double resolution_m, cells_per_m;
  std::int16_t hit, miss, low, high;  // log-odds in units of 1 / kLogOddsScale
  BlockTable blocks;
  std::size_t free_cells = 0, occupied_cells = 0;
  std::uint64_t revision = 0;
  std::shared_ptr<const FlightRegion> region;
  std::vector<Mark> marks;  // all none between two scans, and kept because new memory costs time

  /// Sets a cell's value; updates the counts, the block's revision and the list of changes.
  void set(Block& b, const CellKey& corner, std::uint32_t local, std::int16_t value,
           std::vector<CellChange>& changes) {
    std::int16_t& cell = b.log_odds[local];
    const Cell before = class_of(cell), after = class_of(value);
    cell = value;
    if (before == after) return;
    if (before == Cell::free) --free_cells;
    if (before == Cell::occupied) --occupied_cells;
    if (after == Cell::free) ++free_cells;
    if (after == Cell::occupied) ++occupied_cells;
    b.revision = revision;
    changes.push_back({cell_in(corner, local), before, after});
  }
};

inline void sort_by_key(std::vector<CellChange>& changes) {
  std::sort(changes.begin(), changes.end(),
            [](const CellChange& a, const CellChange& b) { return a.key < b.key; });
}

}  // namespace karst::core
