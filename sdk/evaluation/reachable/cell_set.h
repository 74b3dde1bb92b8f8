// A set of map cells inside fixed bounds: bit blocks of 8x8x8 cells, found through tiles of 16x16x16 blocks.
// Memory and time follow the blocks that hold cells; the bounds cost 4 bytes a tile.
#pragma once
#include <algorithm>
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
  static constexpr int kEdge = 8;       // cells along a block's edge
  static constexpr int kTileEdge = 16;  // blocks along a tile's edge
  /// Of one set: 4 GiB, or 2.7e8 m^3 in cells of 0.2 m.
  static constexpr std::size_t kMaxBlocks = std::size_t{1} << 26;
  /// Slice z holds the cells of one height; bit y * 8 + x.
  using Block = std::array<std::uint64_t, kEdge>;

  CellSet() = default;
  /// The bounds are all blocks that contain a cell from `low` to `high`, both included.
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
    for_each_block([&](const CellKey& place, const Block& b) {
      const CellKey corner = first_cell(place);
      for (int z = 0; z < kEdge; ++z)
        for (std::uint64_t left = b[static_cast<std::size_t>(z)]; left; left &= left - 1) {
          const int bit = std::countr_zero(left);
          visit(corner + CellKey{bit & 7, bit >> 3, z});
        }
    });
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
  /// Whether the block is one of the outermost of the bounds, or lies outside them.
  bool is_outermost(const CellKey& p) const {
    return p.x <= 0 || p.y <= 0 || p.z <= 0 || p.x >= count_.x - 1 || p.y >= count_.y - 1 ||
           p.z >= count_.z - 1;
  }
  /// Number of a block among those made, in the order in which they were made: 0 to block_count() - 1, for
  /// data per block. -1 where find() is null.
  std::int32_t number_of(const CellKey& place) const {
    return has_place(place)
               ? numbers_[tile_numbers_[tile_index(tile_of(place))] * kTilePlaces + inside(place)]
               : -1;
  }
  std::size_t block_count() const { return blocks_.size(); }
  const Block& block(std::int32_t number) const { return blocks_[static_cast<std::size_t>(number)]; }
  /// Null if no cell of that block was ever inserted, or if it lies outside the bounds.
  const Block* find(const CellKey& place) const {
    const std::int32_t i = number_of(place);
    return i < 0 ? nullptr : &block(i);
  }
  Block* find(const CellKey& place) { return const_cast<Block*>(std::as_const(*this).find(place)); }
  /// The block at these block coordinates, created if missing. Invalidates other references to blocks. Throws
  /// std::length_error instead of creating more than kMaxBlocks.
  Block& at(const CellKey& place);
  /// visit(place, block) for the blocks that were made, by z, y, x. `visit` must not make others in this set.
  template <class Visit>
  void for_each_block(const Visit& visit) const;
  /// Number of a block among all of the bounds, by z, y, x.
  std::size_t index_of(const CellKey& p) const {
    return (static_cast<std::size_t>(p.z) * count_.y + p.y) * count_.x + p.x;
  }

  // Tiles, for work on the whole of the bounds. Tile coordinates count from the bounds' low corner, too.
  CellKey tiles_along() const { return tiles_; }
  static CellKey tile_of(const CellKey& place) { return {place.x >> 4, place.y >> 4, place.z >> 4}; }
  /// Whether a block of the tile was made. The tile must lie within the bounds.
  bool has_tile(const CellKey& tile) const { return tile_numbers_[tile_index(tile)] != kNoTile; }
  std::size_t tile_count() const { return numbers_.empty() ? 0 : numbers_.size() / kTilePlaces - 1; }

 private:
  static constexpr std::size_t kTilePlaces = std::size_t{kTileEdge} * kTileEdge * kTileEdge;
  /// The tile that all missing ones share, so that looking up a block does not ask whether there is a tile.
  static constexpr std::uint32_t kNoTile = 0;

  static int bit_of(const CellKey& k) { return (k.y & 7) * kEdge + (k.x & 7); }
  std::size_t tile_index(const CellKey& t) const {
    return (static_cast<std::size_t>(t.z) * tiles_.y + t.y) * tiles_.x + t.x;
  }
  static std::size_t inside(const CellKey& place) {
    return static_cast<std::size_t>((place.z & 15) << 8 | (place.y & 15) << 4 | (place.x & 15));
  }

  CellKey first_, count_;                    // in blocks
  CellKey tiles_;                            // along the bounds
  std::vector<std::uint32_t> tile_numbers_;  // for each tile of the bounds
  std::vector<std::int32_t> numbers_;        // tile after tile: for each place the block's number; -1: none
  std::vector<Block> blocks_;
};

template <class Visit>
void CellSet::for_each_block(const Visit& visit) const {
  struct Tile {
    std::int32_t x, y;
    const std::int32_t* numbers;
  };
  std::vector<Tile> layer;  // of one height, by y, x
  for (CellKey t; t.z < tiles_.z; ++t.z) {
    layer.clear();
    for (t.y = 0; t.y < tiles_.y; ++t.y)
      for (t.x = 0; t.x < tiles_.x; ++t.x)
        if (has_tile(t)) layer.push_back({t.x, t.y, &numbers_[tile_numbers_[tile_index(t)] * kTilePlaces]});
    for (std::int32_t z = 0; z < kTileEdge; ++z)
      for (auto row = layer.begin(), next = row; row != layer.end(); row = next) {
        next = std::find_if(row, layer.end(), [&](const Tile& other) { return other.y != row->y; });
        for (std::int32_t y = 0; y < kTileEdge; ++y)
          for (auto tile = row; tile != next; ++tile)
            for (std::int32_t x = 0; x < kTileEdge; ++x) {
              const std::int32_t number = tile->numbers[inside({x, y, z})];
              if (number < 0) continue;
              const CellKey place{tile->x * kTileEdge + x, tile->y * kTileEdge + y, t.z * kTileEdge + z};
              visit(place, block(number));
            }
      }
  }
}

/// The 6-connected component of `set` that contains `seed`; empty if `set` does not contain it.
CellSet flood(const CellSet& set, const CellKey& seed);
/// The same for the cells within the bounds that are not in `set`. None if the component reaches the
/// outermost blocks of the bounds; that is seen at the first tile that leads there, so that the flood does
/// not fill the space around a cave.
std::optional<CellSet> flood_between(const CellSet& set, const CellKey& seed);

}  // namespace karst::evaluation
