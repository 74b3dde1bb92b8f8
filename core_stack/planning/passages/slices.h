// The space in slices: parts that lie equally far from the start, to a band of two cubes, and are connected.
// Joined slices are the level-set graph of the distance, its Reeb graph (Lazarus and Verroust, Level set
// diagrams of polyhedral objects, 1999). Along a passage it is a chain. Where a passage forks a slice has two
// after it, and where two branches meet again one has two before it.
#pragma once
#include <cstdint>
#include <vector>

#include "core_stack/planning/passages/free_parts.h"

namespace karst::core {

constexpr std::int32_t kBandCubes = 2;

struct Slice {
  std::int32_t band = 0;            // of distances from band to band + 1, times kBandCubes cubes
  std::vector<std::uint32_t> next;  // slices joined to it, sorted; all are of the bands beside it
  std::uint32_t parts = 0;
  std::uint64_t free_cells = 0, frontier_cells = 0;
  std::uint32_t middle = kNoPart;  // of the parts deepest inside, that nearest to the centroid of all
};

struct Slices {
  std::vector<Slice> slices;             // by band
  std::vector<std::uint32_t> slice_of;   // each part
  std::vector<double> from_start_cubes;  // each part: the distance from the start, in edges of a cube
};

Slices sliced(const FreeParts& space);

/// Distance from the space's start to each part, in edges of a cube: the solution of |grad d| = 1 with upwind
/// differences, by fast marching (Sethian, 1996). Level sets are round, however the grid lies.
std::vector<double> marched(const FreeParts& space);

}  // namespace karst::core
