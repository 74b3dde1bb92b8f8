#include "core_stack/planning/passages/known_cubes.h"

#include "core_stack/mapping/occupancy/voxel_reader.h"

namespace karst::core {
namespace {

/// How many cells of the map of each class a merged cell holds, for all merged cells of a cube.
struct ClassCounts {
  std::array<std::uint16_t, 64> free{}, occupied{};
};

/// The cells of a cube with this index along an axis.
BlockBits layer_of_cube(int edge, std::size_t axis, int index) {
  BlockBits out = 0;
  for (int a = 0; a < edge; ++a)
    for (int b = 0; b < edge; ++b) {
      std::array<int, 3> cell{};
      cell[axis] = index;
      cell[(axis + 1) % 3] = a;
      cell[(axis + 2) % 3] = b;
      out |= BlockBits{1} << (cell[0] | cell[1] << 2 | cell[2] << 4);
    }
  return out;
}

}  // namespace

KnownCubes::KnownCubes(const VoxelMap& map, const PassageGrid& grid) : edge_(grid.cube_cells()) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    first_[axis] = layer_of_cube(edge_, axis, 0);
    last_[axis] = layer_of_cube(edge_, axis, edge_ - 1);
  }
  for (int i = 0; i < edge_; ++i) all_ |= layer_of_cube(edge_, 0, i);
  read(map, grid);
  beside_.resize(free_.size());
  for (std::uint32_t c = 0; c < beside_.size(); ++c)
    for (std::size_t f = 0; f < kFaces.size(); ++f) {
      const CellKey there = key(c) + kFaces[f];
      beside_[c][f] = table_.find({there.x, there.y, there.z});
    }
}

void KnownCubes::read(const VoxelMap& map, const PassageGrid& grid) {
  const int shift = grid.merged_shift + grid.cube_shift, mask = edge_ - 1;
  std::vector<ClassCounts> counts;  // only if cells are merged
  CellKey latest{};
  std::uint32_t at = TileTable::none;
  map.for_each_known([&](const CellKey& k, Cell c, float) {
    const CellKey cube{k.x >> shift, k.y >> shift, k.z >> shift};
    if (at == TileTable::none || cube != latest) {
      latest = cube;
      at = table_.find({cube.x, cube.y, cube.z});
      if (at == TileTable::none) {
        at = table_.add({cube.x, cube.y, cube.z});
        free_.push_back(0);
        known_.push_back(0);
        if (grid.merged_shift > 0) counts.emplace_back();
      }
    }
    const auto merged = [&](std::int32_t v) { return (v >> grid.merged_shift) & mask; };
    const auto bit = static_cast<std::size_t>(merged(k.x) | merged(k.y) << 2 | merged(k.z) << 4);
    if (grid.merged_shift == 0) {
      known_[at] |= BlockBits{1} << bit;
      if (c == Cell::free) free_[at] |= BlockBits{1} << bit;
    } else {
      ++(c == Cell::free ? counts[at].free[bit] : counts[at].occupied[bit]);
    }
  });
  const int half = (1 << (3 * grid.merged_shift)) / 2;
  for (std::size_t cube = 0; cube < counts.size(); ++cube)
    for (std::size_t bit = 0; bit < 64; ++bit) {
      const bool rock = counts[cube].occupied[bit] > 0, free = counts[cube].free[bit] >= half;
      if (rock || free) known_[cube] |= BlockBits{1} << bit;
      if (free && !rock) free_[cube] |= BlockBits{1} << bit;
    }
}

BlockBits KnownCubes::frontier(std::uint32_t cube) const {
  const auto unknown = [this](std::uint32_t c) { return all_ & ~known_[c]; };
  BlockBits touching = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) touching |= neighbours(cube, axis, unknown);
  return touching & free_[cube];
}

void KnownCubes::add_path(std::span<const Vec3> path, const PassageGrid& grid,
                          std::vector<BlockBits>& cells) const {
  constexpr double kLongest_m = 1.0;  // of a step: farther, and the estimate has jumped
  const int mask = edge_ - 1;
  for (std::size_t i = 1; i < path.size(); ++i) {
    if ((path[i] - path[i - 1]).norm() > kLongest_m) continue;
    traverse(path[i - 1], path[i], grid.cell_m, [&](const CellKey& k) {
      const std::uint32_t cube =
          table_.find({k.x >> grid.cube_shift, k.y >> grid.cube_shift, k.z >> grid.cube_shift});
      if (cube != TileTable::none)
        cells[cube] |= BlockBits{1} << ((k.x & mask) | (k.y & mask) << 2 | (k.z & mask) << 4);
      return true;
    });
  }
}

std::vector<BlockBits> KnownCubes::with_room(int cells) const {
  const auto not_free = [this](std::uint32_t c) { return all_ & ~free_[c]; };
  std::vector<BlockBits> blocked(size());
  for (std::uint32_t c = 0; c < size(); ++c) {
    for (std::size_t axis = 0; axis < 3; ++axis) blocked[c] |= neighbours(c, axis, not_free);
    blocked[c] &= not_free(c);  // without lonely cells
  }
  std::vector<BlockBits> grown = blocked;
  const auto blocked_of = [&](std::uint32_t c) { return blocked[c]; };
  for (int i = 0; i < cells; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::uint32_t c = 0; c < size(); ++c) grown[c] |= neighbours(c, axis, blocked_of);
      // The first step is to all 26 neighbours, one axis after the other; the others are to 6.
      if (i == 0) blocked = grown;
    }
    blocked = grown;
  }
  for (BlockBits& cells_of_cube : blocked) cells_of_cube = all_ & ~cells_of_cube;
  return blocked;
}

}  // namespace karst::core
