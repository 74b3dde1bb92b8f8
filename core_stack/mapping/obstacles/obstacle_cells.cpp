// Works on whole blocks as bit sets: the cells that touch a free cell are the free cells shifted by one in
// each of the six directions, across block borders where needed.
#include "core_stack/mapping/obstacles/obstacle_cells.h"

#include <bit>
#include <unordered_map>

#include "core_stack/mapping/occupancy/voxel_reader.h"

namespace karst::core {
namespace {

using Bits = std::array<std::uint64_t, 8>;  // one word per z; in it bit x + 8 y

template <class Predicate>
Bits bits_where(const Block& b, Predicate&& holds) {
  Bits bits{};
  for (std::uint32_t z = 0; z < 8; ++z)
    for (std::uint32_t i = 0; i < 64; ++i) bits[z] |= std::uint64_t{holds(b.log_odds[z << 6 | i])} << i;
  return bits;
}

class NearFree {
 public:
  void add(const Block& block) {
    const Bits free = bits_where(block, [](std::int16_t v) { return class_of(v) == Cell::free; });
    if (free == Bits{}) return;
    constexpr std::uint64_t x0 = 0x0101010101010101, x7 = x0 << 7;
    Bits& own = bits_[block.id];
    for (std::size_t z = 0; z < 8; ++z) {
      const std::uint64_t w = free[z];
      own[z] |= (w & ~x7) << 1 | (w & ~x0) >> 1 | w << 8 | w >> 8;
      if (z > 0) own[z - 1] |= w;
      if (z < 7) own[z + 1] |= w;
    }
    spill(block, {-1, 0, 0}, free, [](std::uint64_t w) { return (w & x0) << 7; });
    spill(block, {1, 0, 0}, free, [](std::uint64_t w) { return (w & x7) >> 7; });
    spill(block, {0, -1, 0}, free, [](std::uint64_t w) { return w << 56; });
    spill(block, {0, 1, 0}, free, [](std::uint64_t w) { return w >> 56; });
    const auto same = [](std::uint64_t w) { return w; };
    spill(block, {0, 0, -1}, {0, 0, 0, 0, 0, 0, 0, free[0]}, same);
    spill(block, {0, 0, 1}, {free[7]}, same);
  }
  const std::unordered_map<BlockId, Bits>& bits() const { return bits_; }

 private:
  template <class Move>
  void spill(const Block& block, const CellKey& side, const Bits& free, Move&& move) {
    const CellKey c = corner_of(block.id);
    const CellKey corner{c.x + 8 * side.x, c.y + 8 * side.y, c.z + 8 * side.z};
    Bits moved;
    std::transform(free.begin(), free.end(), moved.begin(), move);
    if (moved == Bits{} || !in_world(corner)) return;
    Bits& there = bits_[block_of(corner)];
    for (std::size_t z = 0; z < 8; ++z) there[z] |= moved[z];
  }

  std::unordered_map<BlockId, Bits> bits_;  // sorted before use
};

}  // namespace

std::vector<CellKey> obstacle_cells(const VoxelMap& map, const CellKey& low, const CellKey& high) {
  const BlockTable& table = VoxelReader(map).blocks();
  NearFree near_free;
  std::vector<std::pair<BlockId, Bits>> blocks;  // cells to be listed, before the box is applied
  for (const Block* b : blocks_in_box(table, low + CellKey{-1, -1, -1}, high + CellKey{1, 1, 1})) {
    near_free.add(*b);
    blocks.emplace_back(b->id, bits_where(*b, [](std::int16_t v) { return class_of(v) == Cell::occupied; }));
  }
  for (auto [id, bits] : near_free.bits()) {
    if (const Block* b = table.find(id)) {
      const Bits unknown = bits_where(*b, [](std::int16_t v) { return v == kUnknown; });
      for (std::size_t z = 0; z < 8; ++z) bits[z] &= unknown[z];
    }
    blocks.emplace_back(id, bits);
  }
  std::sort(blocks.begin(), blocks.end());

  std::vector<CellKey> cells;
  for (const auto& [id, bits] : blocks) {
    const CellKey corner = corner_of(id);
    for (std::uint32_t z = 0; z < 8; ++z)
      for (std::uint64_t rest = bits[z]; rest != 0; rest &= rest - 1) {
        const CellKey k = cell_in(corner, z << 6 | static_cast<std::uint32_t>(std::countr_zero(rest)));
        if (k.x >= low.x && k.x <= high.x && k.y >= low.y && k.y <= high.y && k.z >= low.z && k.z <= high.z)
          cells.push_back(k);
      }
  }
  return cells;
}

}  // namespace karst::core
