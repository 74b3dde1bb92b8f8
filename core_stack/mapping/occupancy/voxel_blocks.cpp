#include "core_stack/mapping/occupancy/voxel_blocks.h"

namespace karst::core {
namespace {

CellKey clamp_to_world(const CellKey& k) {
  const auto c = [](std::int32_t v) { return std::clamp(v, -kWorldCells, kWorldCells - 1); };
  return {c(k.x), c(k.y), c(k.z)};
}

}  // namespace

std::vector<const Block*> blocks_in_box(const BlockTable& table, const CellKey& low, const CellKey& high) {
  std::vector<const Block*> out;
  if (low.x > high.x || low.y > high.y || low.z > high.z) return out;
  const CellKey a = clamp_to_world(low), b = clamp_to_world(high);
  const auto span = [](std::int32_t lo, std::int32_t hi) {
    return static_cast<double>((hi >> 3) - (lo >> 3) + 1);
  };
  if (span(a.x, b.x) * span(a.y, b.y) * span(a.z, b.z) > static_cast<double>(table.all().size())) {
    for (const Block* block : table.sorted()) {
      const CellKey c = corner_of(block->id);
      if (c.x + 7 >= a.x && c.x <= b.x && c.y + 7 >= a.y && c.y <= b.y && c.z + 7 >= a.z && c.z <= b.z)
        out.push_back(block);
    }
    return out;
  }
  for (std::int32_t x = a.x & ~7; x <= b.x; x += kBlockEdge)
    for (std::int32_t y = a.y & ~7; y <= b.y; y += kBlockEdge)
      for (std::int32_t z = a.z & ~7; z <= b.z; z += kBlockEdge)
        if (const Block* block = table.find(block_of({x, y, z}))) out.push_back(block);
  return out;
}

}  // namespace karst::core
