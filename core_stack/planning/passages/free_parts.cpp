#include "core_stack/planning/passages/free_parts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core_stack/mapping/occupancy/voxel_reader.h"
#include "core_stack/planning/passages/known_cubes.h"

namespace karst::core {
namespace {

constexpr double kStartWithin_m = 5.0;
constexpr double kRoom_m = 0.45;

/// The middle of the one of these cells of a cube that is nearest to their mean.
Vec3 middle_of(const PassageGrid& grid, const CellKey& cube, BlockBits cells) {
  const Vec3 corner = grid.cube_cells() * Vec3(cube.x, cube.y, cube.z);
  const auto center = [&](BlockBits left) {  // of the lowest
    const int bit = std::countr_zero(left);
    return Vec3(corner + Vec3(bit & 3, bit >> 2 & 3, bit >> 4) + Vec3::Constant(0.5));
  };
  Vec3 mean = Vec3::Zero();
  for (BlockBits left = cells; left != 0; left &= left - 1) mean += center(left);
  mean /= std::popcount(cells);
  Vec3 nearest = center(cells);
  for (BlockBits left = cells; left != 0; left &= left - 1)
    if ((center(left) - mean).squaredNorm() < (nearest - mean).squaredNorm() - 1e-9) nearest = center(left);
  return nearest * grid.cell_m;
}

/// Parts of all known cubes, whether or not they are connected to the start.
struct AllParts {
  std::vector<FreePart> parts;
  std::vector<std::uint32_t> first_of;  // of each known cube; one more at the end
  std::vector<char> has_room;           // by part: also without the flown path

  AllParts(const KnownCubes& known, const PassageGrid& grid, std::span<const Vec3> flown) {
    const std::vector<BlockBits> with_room = known.with_room(grid.room);
    std::vector<BlockBits> room = with_room;
    known.add_path(flown, grid, room);
    for (std::uint32_t c = 0; c < known.size(); ++c) {
      first_of.push_back(static_cast<std::uint32_t>(parts.size()));
      for (BlockBits left = room[c]; left != 0; left &= ~parts.back().cells) {
        FreePart part;
        part.cube = known.key(c);
        part.cells = face_connected(left);
        const BlockBits free = part.cells & known.free(c);  // without lonely cells
        part.middle = middle_of(grid, part.cube, free != 0 ? free : part.cells);
        parts.push_back(part);
        has_room.push_back((part.cells & with_room[c]) != 0);
      }
    }
    first_of.push_back(static_cast<std::uint32_t>(parts.size()));
  }

  /// Calls visit(part, face) for each part that shares a face of a cell with this one.
  template <class Visit>
  void for_each_joined(const KnownCubes& known, std::uint32_t cube, const FreePart& part,
                       Visit&& visit) const {
    for (std::size_t face = 0; face < kFaces.size(); ++face) {
      const std::uint32_t there = known.beside(cube)[face];
      const BlockBits touched = known.across(part.cells, face);
      if (there == TileTable::none || touched == 0) continue;
      for (std::uint32_t p = first_of[there]; p < first_of[there + 1]; ++p)
        if (parts[p].cells & touched) visit(p, face);
    }
  }

 private:
  /// The component that holds the lowest bit.
  static BlockBits face_connected(BlockBits cells) {
    BlockBits part = cells & (~cells + 1), before = 0;
    while (part != before) {
      before = part;
      part = (grown_x(part) | grown_y(part) | grown_z(part)) & cells;
    }
    return part;
  }
};

/// The known cube of each part.
std::vector<std::uint32_t> cubes_of(const AllParts& all) {
  std::vector<std::uint32_t> out(all.parts.size());
  for (std::uint32_t c = 0; c + 1 < all.first_of.size(); ++c)
    for (std::uint32_t p = all.first_of[c]; p < all.first_of[c + 1]; ++p) out[p] = c;
  return out;
}

/// A part that was flown only, such as the air above the launch site, if there is none with room.
std::uint32_t nearest_to_start(const AllParts& all, const Vec3& start) {
  for (const bool roomy : {true, false}) {
    std::uint32_t nearest = kNoPart;
    double least = kStartWithin_m * kStartWithin_m;
    for (std::uint32_t p = 0; p < all.parts.size(); ++p) {
      if (roomy && !all.has_room[p]) continue;
      if (const double away = (all.parts[p].middle - start).squaredNorm(); away < least) {
        least = away;
        nearest = p;
      }
    }
    if (nearest != kNoPart) return nearest;
  }
  return kNoPart;
}

std::vector<char> connected_to(std::uint32_t first, const KnownCubes& known, const AllParts& all,
                               const std::vector<std::uint32_t>& cube_of) {
  std::vector<char> reached(all.parts.size());
  std::vector<std::uint32_t> open{first};
  reached[first] = 1;
  while (!open.empty()) {
    const std::uint32_t at = open.back();
    open.pop_back();
    all.for_each_joined(known, cube_of[at], all.parts[at], [&](std::uint32_t there, std::size_t) {
      if (reached[there]) return;
      reached[there] = 1;
      open.push_back(there);
    });
  }
  return reached;
}

/// The part to which the cells of each known cube count: the first of its own, or that of the cube across the
/// face with most free cells on both sides. kNoPart if there is none.
std::vector<std::uint32_t> owners(const KnownCubes& known, std::vector<std::uint32_t> first_in) {
  constexpr int kNeighbourRounds = 3;  // across a face, an edge and a corner
  for (int round = 0; round < kNeighbourRounds; ++round) {
    const std::vector<std::uint32_t> before = first_in;
    for (std::uint32_t c = 0; c < known.size(); ++c) {
      int most = 0;
      for (std::size_t face = 0; face < kFaces.size() && before[c] == kNoPart; ++face) {
        const std::uint32_t there = known.beside(c)[face];
        if (there == TileTable::none || before[there] == kNoPart) continue;
        const int shared = std::popcount(known.across(known.free(c), face) & known.free(there));
        if (shared <= most) continue;
        most = shared;
        first_in[c] = before[there];
      }
    }
  }
  return first_in;
}

}  // namespace

PassageGrid passage_grid(double resolution_m) {
  constexpr double kMerged_m = 0.25 + 1e-9, kCube_m = 1 + 1e-9;
  constexpr int kMostMerged = 4;  // 4096 cells in a merged one
  PassageGrid g;
  g.cell_m = resolution_m;
  for (; g.merged_shift < kMostMerged && 2 * g.cell_m <= kMerged_m; ++g.merged_shift) g.cell_m *= 2;
  while (g.cube_shift < 2 && 2 * g.cube_m() <= kCube_m) ++g.cube_shift;
  g.room = std::min(3, static_cast<int>(kRoom_m / g.cell_m + 1e-9));
  return g;
}

std::uint32_t FreeParts::nearest(const Vec3& p) const {
  constexpr std::int32_t kAround = 2;
  if (parts.empty() || !(p.array().abs() < 1e6).all()) return kNoPart;  // NaN as well
  const auto key = [&](double v) { return static_cast<std::int32_t>(std::floor(v / grid.cube_m())); };
  const CellKey own{key(p.x()), key(p.y()), key(p.z())};
  std::uint32_t nearest = kNoPart;
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const CellKey& k) {
    const std::uint32_t cube = cubes.find({k.x, k.y, k.z});
    if (cube == TileTable::none) return;
    for (std::uint32_t i = first_part[cube]; i < first_part[cube + 1]; ++i)
      if (const double away = (parts[i].middle - p).squaredNorm(); away < least) {
        least = away;
        nearest = i;
      }
  };
  look(own);
  for (std::int32_t z = -kAround; z <= kAround && cubes.find({own.x, own.y, own.z}) == TileTable::none; ++z)
    for (std::int32_t y = -kAround; y <= kAround; ++y)
      for (std::int32_t x = -kAround; x <= kAround; ++x) look(own + CellKey{x, y, z});
  return nearest;
}

std::optional<FreeParts> free_parts_around(const VoxelMap& map, const Vec3& start, WorkBudget& work,
                                           std::span<const Vec3> flown) {
  FreeParts space;
  space.grid = passage_grid(map.resolution_m());
  if (!work.spend(map.free_cells() + map.occupied_cells())) return std::nullopt;
  const KnownCubes known(map, space.grid);
  const AllParts all(known, space.grid, flown);
  if (!work.spend(kPartWork * all.parts.size())) return std::nullopt;
  const std::uint32_t first = nearest_to_start(all, start);
  if (first == kNoPart) return space;
  const std::vector<std::uint32_t> cube_of = cubes_of(all);
  const std::vector<char> reached = connected_to(first, known, all, cube_of);

  std::vector<std::uint32_t> number(all.parts.size(), kNoPart), first_in(known.size(), kNoPart);
  for (std::uint32_t p = 0; p < all.parts.size(); ++p) {
    if (!reached[p]) continue;
    number[p] = static_cast<std::uint32_t>(space.parts.size());
    if (first_in[cube_of[p]] == kNoPart) {
      first_in[cube_of[p]] = number[p];
      const CellKey& k = all.parts[p].cube;
      space.cubes.add({k.x, k.y, k.z});
      space.first_part.push_back(number[p]);
    }
    space.parts.push_back(all.parts[p]);
  }
  space.first_part.push_back(static_cast<std::uint32_t>(space.parts.size()));
  space.start = number[first];
  for (std::uint32_t p = 0; p < all.parts.size(); ++p) {
    if (!reached[p]) continue;
    FreePart& part = space.parts[number[p]];
    part.first_link = static_cast<std::uint32_t>(space.links.size());
    unsigned faces = 0;
    all.for_each_joined(known, cube_of[p], part, [&](std::uint32_t there, std::size_t face) {
      space.links.push_back({number[there], static_cast<std::uint32_t>(face / 2)});
      faces |= 1u << face;
    });
    part.last_link = static_cast<std::uint32_t>(space.links.size());
    part.is_inside = faces == 0b111111u;
  }
  const std::vector<std::uint32_t> owner = owners(known, first_in);
  for (std::uint32_t c = 0; c < known.size(); ++c) {
    if (owner[c] == kNoPart) continue;
    FreePart& part = space.parts[owner[c]];
    part.free_cells += static_cast<std::uint32_t>(std::popcount(known.free(c)));
    part.frontier_cells += static_cast<std::uint32_t>(std::popcount(known.frontier(c)));
  }
  return space;
}

}  // namespace karst::core
