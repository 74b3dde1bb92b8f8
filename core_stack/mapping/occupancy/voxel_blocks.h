// Blocks of 8x8x8 log-odds and the table that finds them; private to mapping.
//
// The table is open-addressed with linear probing over one plain vector: a look-up takes one multiplication
// and, nearly always, one cache line. Blocks have stable addresses.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "core_stack/mapping/occupancy/packed_cell.h"

namespace karst::core {

constexpr std::int32_t kBlockEdge = 8;
constexpr std::int32_t kWorldCells = 32768;  // OctoMap's keys reach from -32768 to 32767 in each axis
constexpr std::int16_t kUnknown = std::numeric_limits<std::int16_t>::min();
constexpr float kLogOddsScale = 4096.0f;  // units per 1.0 of log-odds: +-8 means p = 0.0003 to 0.9997

inline bool in_world(const CellKey& k) {
  const auto offset = [](std::int32_t v) { return static_cast<std::uint32_t>(v) + kWorldCells; };
  return ((offset(k.x) | offset(k.y) | offset(k.z)) & ~0xffffu) == 0;
}

/// A block's id: its lowest cell.
using BlockId = PackedCell;

inline BlockId block_of(const CellKey& k) { return pack(k) & ~kInBlock; }
inline CellKey corner_of(BlockId id) { return unpack(id); }
/// Index of a cell in its block, x fastest.
inline std::uint32_t local_of(const CellKey& k) {
  return static_cast<std::uint32_t>((k.x & 7) | (k.y & 7) << 3 | (k.z & 7) << 6);
}
inline CellKey cell_in(const CellKey& corner, std::uint32_t local) {
  return {corner.x + static_cast<std::int32_t>(local & 7),
          corner.y + static_cast<std::int32_t>(local >> 3 & 7),
          corner.z + static_cast<std::int32_t>(local >> 6)};
}

inline Cell class_of(std::int16_t v) {
  if (v == kUnknown) return Cell::unknown;
  return v < 0 ? Cell::free : Cell::occupied;
}

struct Block {
  explicit Block(BlockId name) : id(name) { log_odds.fill(kUnknown); }
  std::array<std::int16_t, 512> log_odds;
  BlockId id;
  std::uint64_t revision = 0;
};

class BlockTable {
 public:
  BlockTable() : slots_(1024) {}

  Block* find(BlockId id) const {
    for (std::size_t i = slot_of(id, slots_.size());; i = (i + 1) & (slots_.size() - 1)) {
      if (slots_[i].block == nullptr || slots_[i].id == id) return slots_[i].block;
    }
  }
  Block& find_or_add(BlockId id) {
    if (Block* b = find(id)) return *b;
    blocks_.push_back(std::make_unique<Block>(id));
    if (2 * blocks_.size() > slots_.size()) {
      slots_.assign(2 * slots_.size(), {});
      for (const auto& b : blocks_) place(b.get());
    } else {
      place(blocks_.back().get());
    }
    return *blocks_.back();
  }
  const std::vector<std::unique_ptr<Block>>& all() const { return blocks_; }
  std::vector<const Block*> sorted() const {
    std::vector<const Block*> out;
    out.reserve(blocks_.size());
    for (const auto& b : blocks_) out.push_back(b.get());
    std::sort(out.begin(), out.end(), [](const Block* a, const Block* b) { return a->id < b->id; });
    return out;
  }

 private:
  struct Slot {
    BlockId id = 0;
    Block* block = nullptr;
  };
  void place(Block* b) {
    std::size_t i = slot_of(b->id, slots_.size());
    while (slots_[i].block != nullptr) i = (i + 1) & (slots_.size() - 1);
    slots_[i] = {b->id, b};
  }

  std::vector<Slot> slots_;  // a power of two, at most half full
  std::vector<std::unique_ptr<Block>> blocks_;
};

/// Blocks that touch the closed box of cells, sorted. Iterates over the box or all blocks, whichever is less.
std::vector<const Block*> blocks_in_box(const BlockTable& table, const CellKey& low, const CellKey& high);

}  // namespace karst::core
