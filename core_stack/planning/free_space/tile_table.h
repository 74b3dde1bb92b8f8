// An open-addressed hash table from a tile's key to its dense index.
#pragma once
#include <cstdint>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// A tile is 32 x 8 x 8 cells: rows of 32 bits along x.
constexpr std::int32_t kTileX = 32, kTileY = 8, kTileZ = 8;
constexpr std::uint32_t kTileRows = 64;  // index (y & 7) | (z & 7) << 3
constexpr std::uint32_t kTileCells = 32 * kTileRows;

struct TileKey {
  std::int32_t x = 0, y = 0, z = 0;
  bool operator==(const TileKey&) const = default;
};
inline TileKey tile_of(const CellKey& k) { return {k.x >> 5, k.y >> 3, k.z >> 3}; }
inline CellKey corner_of(const TileKey& t) { return {t.x * kTileX, t.y * kTileY, t.z * kTileZ}; }
inline std::uint32_t row_of(std::int32_t y, std::int32_t z) {
  return static_cast<std::uint32_t>((y & 7) | (z & 7) << 3);
}
inline std::uint32_t index_in_tile(const CellKey& k) {
  return static_cast<std::uint32_t>(k.x & 31) | row_of(k.y, k.z) << 5;
}
inline CellKey cell_in_tile(const CellKey& corner, std::uint32_t index) {
  return {corner.x + static_cast<std::int32_t>(index & 31),
          corner.y + static_cast<std::int32_t>(index >> 5 & 7),
          corner.z + static_cast<std::int32_t>(index >> 8)};
}

class TileTable {
 public:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  std::uint32_t find(const TileKey& t) const {
    for (std::size_t i = slot_of(t);; i = (i + 1) & (slots_.size() - 1))
      if (slots_[i].index == none || slots_[i].key == t) return slots_[i].index;
  }
  /// Assigns the next index to `t`, which must be new.
  std::uint32_t add(const TileKey& t) {
    if (2 * (keys_.size() + 1) > slots_.size()) {
      slots_.assign(2 * slots_.size(), {});
      for (std::uint32_t i = 0; i < keys_.size(); ++i) place(keys_[i], i);
    }
    const auto index = static_cast<std::uint32_t>(keys_.size());
    keys_.push_back(t);
    place(t, index);
    return index;
  }
  const std::vector<TileKey>& keys() const { return keys_; }

 private:
  struct Slot {
    TileKey key;
    std::uint32_t index = none;
  };
  std::size_t slot_of(const TileKey& t) const {
    const auto part = [](std::int32_t v) { return static_cast<std::uint64_t>(v + 0x8000) & 0xffff; };
    const std::uint64_t name = part(t.x) << 32 | part(t.y) << 16 | part(t.z);
    return (name * 0x9e3779b97f4a7c15ull >> 24) & (slots_.size() - 1);
  }
  void place(const TileKey& t, std::uint32_t index) {
    std::size_t i = slot_of(t);
    while (slots_[i].index != none) i = (i + 1) & (slots_.size() - 1);
    slots_[i] = {t, index};
  }

  std::vector<Slot> slots_ = std::vector<Slot>(256);  // a power of two, at most half full
  std::vector<TileKey> keys_;
};

}  // namespace karst::core
