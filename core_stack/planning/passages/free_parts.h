// The space around the start in which a vehicle has room, in pieces: small enough to keep passages apart, few
// enough for a question about the whole map.
//
// A map of small cells is read in merged cells of up to 0.25 m: free if no cell in it is occupied and half of
// them are free. A merged cell has room if all merged cells around it are free, to 0.45 m. Cells with room
// are cut into cubes of 4 x 4 x 4; the connected ones of a cube are a part, and parts are joined where their
// cells share faces. So a crack, a fan of single rays or a hole in a wall is no part of the space, and joined
// parts are connected in the map: a wall keeps them apart, however thin it is. A lonely cell that is not
// free, with free cells on all six sides, counts as free: it is dust, or a gap between rays.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core_stack/planning/free_space/block_bits.h"
#include "core_stack/planning/free_space/tile_table.h"
#include "core_stack/planning/roadmap/work_budget.h"

namespace karst::core {

constexpr std::uint32_t kNoPart = TileTable::none;

/// How a map is divided. Lengths are powers of two of cells.
struct PassageGrid {
  int merged_shift = 0;  // log2 of the edge of a merged cell, in cells of the map
  int cube_shift = 0;    // log2 of the edge of a cube, in merged cells
  int room = 0;          // merged cells that must be free on each side
  double cell_m = 0;     // edge of a merged cell

  std::int32_t cube_cells() const { return 1 << cube_shift; }
  double cube_m() const { return cube_cells() * cell_m; }
};

PassageGrid passage_grid(double resolution_m);

struct PartLink {
  std::uint32_t part;
  std::uint32_t axis;
};

struct FreePart {
  CellKey cube;                // holds the merged cells [cube, cube + 1) * cube_cells() of each axis
  BlockBits cells = 0;         // bits of block_bits.h
  Vec3 middle = Vec3::Zero();  // of the cell that is nearest to the mean of all
  std::uint32_t first_link = 0, last_link = 0;  // its links are those from the first to before the last
  bool is_inside = false;                       // it has a link across every face
  // Free merged cells, and those with an unknown face neighbour, with or without room: those of its cube, if
  // it is the first part there, and of the cubes beside it without a part.
  std::uint32_t free_cells = 0, frontier_cells = 0;
};

struct FreeParts {
  PassageGrid grid;
  std::vector<FreePart> parts;  // all of them are connected; by cube
  std::vector<PartLink> links;  // of each part, by axis
  std::uint32_t start = kNoPart;
  TileTable cubes;                        // those with parts
  std::vector<std::uint32_t> first_part;  // of each cube; one more at the end

  std::span<const PartLink> links_of(std::uint32_t part) const {
    const FreePart& p = parts[part];
    return std::span(links).subspan(p.first_link, p.last_link - p.first_link);
  }
  /// The part nearest to `p`, by its middle, of the cube that holds `p` or else of the 124 around it.
  /// kNoPart: there is none.
  std::uint32_t nearest(const Vec3& p) const;
};

/// Work of one question about passages: a known cell of the map counts 1. About a second.
constexpr std::uint64_t kMaxPassageWork = 50'000'000;
constexpr std::uint64_t kPartWork = 60, kSliceWork = 1000;

/// The parts connected to the one nearest to `start`; none if there is none within 5 m of it. nullopt once
/// `work` is exhausted. Cells on the path `flown` have room in any case: a vehicle has come through there.
std::optional<FreeParts> free_parts_around(const VoxelMap& map, const Vec3& start, WorkBudget& work,
                                           std::span<const Vec3> flown = {});

}  // namespace karst::core
