// Which cells the beams of one scan pass and hit; private to mapping.
//
// Neighbouring beams pass the same cells, and which block of the map comes next along a beam cannot be
// predicted. So a scan is marked first, a byte a cell in an array over its box, and the map is changed after
// it, row by row. This takes two thirds of the time that looking up the map's blocks along each beam takes.
#pragma once
#include <bit>
#include <cstring>
#include <span>
#include <unordered_map>
#include <vector>

#include "core_stack/mapping/occupancy/cell_walk.h"
#include "core_stack/mapping/occupancy/voxel_blocks.h"

namespace karst::core {

/// From one place in the world to another, both in units of cells; `first` and `last` are their cells.
struct Beam {
  Vec3 from, to;
  CellKey first, last;
  bool hit;
};

enum class Mark : std::uint8_t { none = 0, miss = 1, hit = 2 };

/// Calls visit(index of the cell in its block, whether it is hit) for the marks of eight cells in a row.
template <class Visit>
void for_each_mark(std::uint32_t first, std::uint64_t eight, Visit&& visit) {
  while (eight != 0) {  // byte i is that of cell i: x86-64 is little-endian
    const auto i = static_cast<std::uint32_t>(std::countr_zero(eight)) / 8;
    visit(first + i, (eight >> 8 * i & 0xff) == static_cast<std::uint64_t>(Mark::hit));
    eight &= ~(std::uint64_t{0xff} << 8 * i);
  }
}

/// The cells of the blocks that a box touches, x fastest.
class MarkGrid {
 public:
  /// `cells` is all Mark::none, and is so again after for_each_row(): it serves for the next scan.
  MarkGrid(const CellKey& low, const CellKey& high, std::vector<Mark>& cells)
      : low_{low.x & ~7, low.y & ~7, low.z & ~7},
        size_{(high.x | 7) + 1 - low_.x, (high.y | 7) + 1 - low_.y, (high.z | 7) + 1 - low_.z},
        cells_(cells) {}

  double cell_count() const { return static_cast<double>(size_.x) * size_.y * size_.z; }

  void mark(std::span<const Beam> beams) {
    if (static_cast<double>(cells_.size()) < cell_count())
      cells_.resize(static_cast<std::size_t>(cell_count()));
    std::size_t i = 0;
    for (; i + 1 < beams.size(); i += 2) miss(beams[i], beams[i + 1]);
    if (i < beams.size()) miss(walk_of(beams[i]), at(beams[i].first));
    for (const Beam& b : beams)
      if (b.hit) *at(b.last) = Mark::hit;
  }

  /// Calls visit(block, index of the first cell in it, eight marks) for each row of a block with a mark.
  template <class Visit>
  void for_each_row(Visit&& visit) {
    Mark* row = cells_.data();
    for (std::int32_t z = 0; z < size_.z; ++z)
      for (std::int32_t y = 0; y < size_.y; ++y)
        for (std::int32_t x = 0; x < size_.x; x += kBlockEdge, row += kBlockEdge) {
          std::uint64_t eight;
          std::memcpy(&eight, row, sizeof eight);
          if (eight == 0) continue;
          std::memset(row, 0, sizeof eight);
          const CellKey first = low_ + CellKey{x, y, z};
          visit(block_of(first), local_of(first), eight);
        }
  }

 private:
  std::uint64_t stride_y() const { return static_cast<std::uint64_t>(size_.x); }
  std::uint64_t stride_z() const { return stride_y() * static_cast<std::uint64_t>(size_.y); }
  Mark* at(const CellKey& k) {
    const auto part = [](std::int32_t v) { return static_cast<std::uint64_t>(v); };
    return cells_.data() + part(k.x - low_.x) + stride_y() * part(k.y - low_.y) +
           stride_z() * part(k.z - low_.z);
  }
  CellWalk walk_of(const Beam& b) const { return {b.from, b.to, {1, stride_y(), stride_z()}}; }

  /// Marks all cells of a walk from `first` except its last one.
  static void miss(CellWalk walk, Mark* first) {
    for (std::int32_t left = walk.steps(); left > 0; --left, walk.advance())
      first[static_cast<std::ptrdiff_t>(walk.cell())] = Mark::miss;
  }
  /// Two at a time: a step waits for the one before it, but not for that of the other beam.
  void miss(const Beam& one, const Beam& other) {
    CellWalk a = walk_of(one), b = walk_of(other);
    Mark *const at_a = at(one.first), *const at_b = at(other.first);
    const std::int32_t both = std::min(a.steps(), b.steps()), left_a = a.steps() - both,
                       left_b = b.steps() - both;
    for (std::int32_t left = both; left > 0; --left, a.advance(), b.advance()) {
      at_a[static_cast<std::ptrdiff_t>(a.cell())] = Mark::miss;
      at_b[static_cast<std::ptrdiff_t>(b.cell())] = Mark::miss;
    }
    for (std::int32_t left = left_a; left > 0; --left, a.advance())
      at_a[static_cast<std::ptrdiff_t>(a.cell())] = Mark::miss;
    for (std::int32_t left = left_b; left > 0; --left, b.advance())
      at_b[static_cast<std::ptrdiff_t>(b.cell())] = Mark::miss;
  }

  CellKey low_, size_;
  std::vector<Mark>& cells_;
};

/// The same for scans whose box is too large for an array: long beams through fine cells.
class MarkedBlocks {
 public:
  void mark(std::span<const Beam> beams) {
    for (const Beam& b : beams) {
      CellWalk walk(b.from, b.to);
      for (std::int32_t left = walk.steps(); left > 0; --left, walk.advance()) set(walk.cell(), Mark::miss);
    }
    for (const Beam& b : beams)
      if (b.hit) set(pack(b.last), Mark::hit);
  }
  template <class Visit>
  void for_each_row(Visit&& visit) const {
    std::vector<BlockId> ids;
    for (const auto& [id, marks] : blocks_) ids.push_back(id);
    std::sort(ids.begin(), ids.end());
    for (const BlockId id : ids)
      for (std::uint32_t row = 0; row < kCells; row += kBlockEdge) {
        std::uint64_t eight;
        std::memcpy(&eight, blocks_.at(id).data() + row, sizeof eight);
        if (eight != 0) visit(id, row, eight);
      }
  }

 private:
  static constexpr std::uint32_t kCells = kBlockEdge * kBlockEdge * kBlockEdge;

  void set(PackedCell p, Mark mark) {
    if ((p & ~kInBlock) != id_) {
      id_ = p & ~kInBlock;
      last_ = blocks_[id_].data();
    }
    last_[word_in_block(p) << 6 | bit_in_block(p)] = mark;
  }

  std::unordered_map<BlockId, std::array<Mark, kCells>> blocks_;
  BlockId id_ = ~BlockId{0};
  Mark* last_ = nullptr;
};

}  // namespace karst::core
