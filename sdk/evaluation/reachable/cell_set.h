// A set of map cells inside fixed bounds: bit blocks of 8x8x8 cells, found through a dense table.
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::evaluation {

using core::CellKey;

inline core::Vec3 center_of(const CellKey& k, double resolution_m) {
  return core::Vec3(k.x + 0.5, k.y + 0.5, k.z + 0.5) * resolution_m;
}

class CellSet {
 public:
  static constexpr int kEdge = 8;  // cells along a block's edge
  /// Slice z holds the cells of one height; bit y * 8 + x.
  using Block = std::array<std::uint64_t, kEdge>;

  CellSet() = default;
  /// Reserves all blocks that contain a cell from `low` to `high`, both included.
  CellSet(const CellKey& low, const CellKey& high);

  bool contains(const CellKey& k) const {
    const Block* b = find(block_of(k));
    return b && ((*b)[k.z & 7] >> bit_of(k) & 1u);
  }
  /// The cell must lie within the bounds.
  void insert(const CellKey& k) { at(block_of(k))[k.z & 7] |= std::uint64_t{1} << bit_of(k); }

  std::size_t size() const;

  /// Cells in a fixed order: blocks by z, y, x, and the cells of a block likewise (x runs fastest).
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t i = 0; i < index_.size(); ++i) {
      if (index_[i] < 0) continue;
      const CellKey corner = corner_of(i);
      const Block& b = blocks_[static_cast<std::size_t>(index_[i])];
      for (int z = 0; z < kEdge; ++z)
        for (std::uint64_t left = b[static_cast<std::size_t>(z)]; left; left &= left - 1) {
          const int bit = std::countr_zero(left);
          visit(corner + CellKey{bit & 7, bit >> 3, z});
        }
    }
  }

  // Access by block, for work on 64 cells at a time. Block coordinates count from the bounds' low corner.
  CellKey blocks_along() const { return count_; }
  CellKey block_of(const CellKey& k) const {
    return {(k.x >> 3) - first_.x, (k.y >> 3) - first_.y, (k.z >> 3) - first_.z};
  }
  CellKey first_cell(const CellKey& place) const {
    return {(place.x + first_.x) * kEdge, (place.y + first_.y) * kEdge, (place.z + first_.z) * kEdge};
  }
  bool has_place(const CellKey& p) const {
    return p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < count_.x && p.y < count_.y && p.z < count_.z;
  }
  /// Null if no cell of that block was ever inserted, or if it lies outside the bounds.
  const Block* find(const CellKey& place) const {
    if (!has_place(place)) return nullptr;
    const std::int32_t i = index_[index_of(place)];
    return i < 0 ? nullptr : &blocks_[static_cast<std::size_t>(i)];
  }
  Block* find(const CellKey& place) { return const_cast<Block*>(std::as_const(*this).find(place)); }
  /// The block at these block coordinates, created if missing. Invalidates other references to blocks.
  Block& at(const CellKey& place);
  std::size_t index_of(const CellKey& p) const {
    return (static_cast<std::size_t>(p.z) * count_.y + p.y) * count_.x + p.x;
  }

 private:
  static int bit_of(const CellKey& k) { return (k.y & 7) * kEdge + (k.x & 7); }
  CellKey corner_of(std::size_t index) const;

  CellKey first_, count_;            // in blocks
  std::vector<std::int32_t> index_;  // for each block of the bounds; -1 if there is none
  std::vector<Block> blocks_;
};

/// The 6-connected component of `set` that contains `seed`; empty if `set` does not contain it.
CellSet flood(const CellSet& set, const CellKey& seed);
/// The same for the cells within the bounds that are not in `set`. None if the component reaches the
/// outermost blocks of the bounds.
std::optional<CellSet> flood_between(const CellSet& set, const CellKey& seed);

}  // namespace karst::evaluation
