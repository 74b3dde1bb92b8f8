#include "core_stack/mapping/occupancy/voxel_reader.h"

namespace karst::core {

CellCounts VoxelReader::count(const CellKey& low, const CellKey& high) const {
  CellCounts counts;
  const auto span = [](std::int32_t a, std::int32_t b) { return static_cast<std::uint32_t>(b - a + 1); };
  if (low.x > high.x || low.y > high.y || low.z > high.z) return counts;
  std::uint32_t free = 0, occupied = 0;
  for (std::int32_t bx = low.x & ~7; bx <= high.x; bx += kBlockEdge)
    for (std::int32_t by = low.y & ~7; by <= high.y; by += kBlockEdge)
      for (std::int32_t bz = low.z & ~7; bz <= high.z; bz += kBlockEdge) {
        const Block* block = in_world({bx, by, bz}) ? blocks_.find(block_of({bx, by, bz})) : nullptr;
        if (block == nullptr) continue;
        const std::int32_t x0 = std::max(low.x - bx, 0), x1 = std::min(high.x - bx, 7);
        const std::int32_t y0 = std::max(low.y - by, 0), y1 = std::min(high.y - by, 7);
        const std::int32_t z0 = std::max(low.z - bz, 0), z1 = std::min(high.z - bz, 7);
        // Whole rows, summed per x, so that the compiler vectorizes each row.
        std::array<std::int16_t, kBlockEdge> free_at{}, occupied_at{};
        for (std::int32_t z = z0; z <= z1; ++z)
          for (std::int32_t y = y0; y <= y1; ++y) {
            const std::int16_t* row = block->log_odds.data() + (z << 6 | y << 3);
            for (std::size_t x = 0; x < kBlockEdge; ++x) {
              free_at[x] = static_cast<std::int16_t>(free_at[x] + ((row[x] < 0) & (row[x] != kUnknown)));
              occupied_at[x] = static_cast<std::int16_t>(occupied_at[x] + (row[x] >= 0));
            }
          }
        for (auto x = static_cast<std::size_t>(x0); x <= static_cast<std::size_t>(x1); ++x) {
          free += static_cast<std::uint32_t>(free_at[x]);
          occupied += static_cast<std::uint32_t>(occupied_at[x]);
        }
      }
  counts.free = free;
  counts.occupied = occupied;
  counts.unknown = span(low.x, high.x) * span(low.y, high.y) * span(low.z, high.z) - free - occupied;
  return counts;
}

std::vector<Cell> VoxelReader::classes(const CellKey& low, const CellKey& high) const {
  if (low.x > high.x || low.y > high.y || low.z > high.z) return {};
  const auto span = [](std::int32_t a, std::int32_t b) { return static_cast<std::size_t>(b - a + 1); };
  const std::size_t row = span(low.x, high.x), layer = row * span(low.y, high.y);
  std::vector<Cell> out(layer * span(low.z, high.z), Cell::unknown);
  for (const Block* b : blocks_in_box(blocks_, low, high)) {
    const CellKey c = corner_of(b->id);
    const CellKey from{std::max(c.x, low.x), std::max(c.y, low.y), std::max(c.z, low.z)};
    const CellKey to{std::min(c.x + 7, high.x), std::min(c.y + 7, high.y), std::min(c.z + 7, high.z)};
    for (std::int32_t z = from.z; z <= to.z; ++z)
      for (std::int32_t y = from.y; y <= to.y; ++y) {
        const auto cells = std::span(b->log_odds).subspan(local_of({from.x, y, z}), span(from.x, to.x));
        Cell* const at = out.data() + (z - low.z) * static_cast<std::ptrdiff_t>(layer) +
                         (y - low.y) * static_cast<std::ptrdiff_t>(row) + (from.x - low.x);
        std::transform(cells.begin(), cells.end(), at, class_of);
      }
  }
  return out;
}

}  // namespace karst::core
