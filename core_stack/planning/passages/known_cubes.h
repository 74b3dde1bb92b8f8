// The known cells of a map as bitmaps of cubes, for FreeParts. Private to passages.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "core_stack/planning/passages/free_parts.h"

namespace karst::core {

class KnownCubes {
 public:
  KnownCubes(const VoxelMap& map, const PassageGrid& grid);

  std::size_t size() const { return free_.size(); }
  CellKey key(std::uint32_t cube) const {
    const TileKey& t = table_.keys()[cube];
    return {t.x, t.y, t.z};
  }
  /// The cubes across its faces, in the order of kFaces; TileTable::none where nothing is known.
  const std::array<std::uint32_t, 6>& beside(std::uint32_t cube) const { return beside_[cube]; }
  BlockBits free(std::uint32_t cube) const { return free_[cube]; }
  /// Free cells with an unknown face neighbour.
  BlockBits frontier(std::uint32_t cube) const;
  /// For each cube, the cells that have room around them. Lonely cells that are not free, with free cells on
  /// all six sides, count as free.
  std::vector<BlockBits> with_room(int cells) const;
  /// Adds the cells that a path leads through to `cells`, those of each cube, where anything is known.
  void add_path(std::span<const Vec3> path, const PassageGrid& grid, std::vector<BlockBits>& cells) const;
  /// The cells on a face, moved to the place of those that touch them in the next cube.
  BlockBits across(BlockBits cells, std::size_t face) const {
    const std::size_t axis = face / 2;
    const int steps = (edge_ - 1) << (2 * axis);
    return face % 2 == 0 ? (cells & first_[axis]) << steps : (cells & last_[axis]) >> steps;
  }

 private:
  void read(const VoxelMap& map, const PassageGrid& grid);
  /// The cells with a neighbour along an axis, in their own cube or the next, for which cells_of(cube) has
  /// the bit set. Of cubes without a known cell all are set.
  template <class CellsOf>
  BlockBits neighbours(std::uint32_t cube, std::size_t axis, CellsOf&& cells_of) const {
    const int step = 1 << (2 * axis);
    const BlockBits own = cells_of(cube);
    BlockBits out = (own & ~last_[axis]) << step | (own & ~first_[axis]) >> step;
    for (const std::size_t face : {2 * axis, 2 * axis + 1}) {
      const std::uint32_t there = beside_[cube][face];
      out |= across(there == TileTable::none ? all_ : cells_of(there), face ^ 1);
    }
    return out;
  }

  int edge_;
  BlockBits all_ = 0;                      // cells of a cube
  std::array<BlockBits, 3> first_, last_;  // those at either end of an axis
  TileTable table_;
  std::vector<BlockBits> free_, known_;
  std::vector<std::array<std::uint32_t, 6>> beside_;
};

}  // namespace karst::core
