// The A* search itself, on cells: 26 moves, costs 1, sqrt 2, sqrt 3 cells, octile heuristic.
#pragma once
#include <vector>

#include "core_stack/planning/free_space/free_tiles.h"

namespace karst::core {

struct GridSearchResult {
  enum class End { found, exhausted, gave_up } end = End::exhausted;
  std::vector<CellKey> cells;  // when found: from one of the starts to one of the goals
  std::int64_t expansions = 0;
};

/// Octile length of a displacement in cells: the cost of the cheapest lattice path between two cells in free
/// space.
double octile_cells(const Vec3& displacement);

/// From any of `starts` to any of `goals`, which count with their octile distance to `from` and `to`.
struct GridQuery {
  std::vector<CellKey> starts, goals;
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  // in cells, centres at whole numbers
  double weight = 1;                            // the way is at most so many times longer than the best
  std::int64_t max_expansions = 0;
};

/// Shortest way through clear cells. Tiles of `free` are read from the map as the search gets there.
GridSearchResult search_grid(const VoxelMap& map, FreeTiles& free, const ClearanceRule& rule,
                             const GridQuery& query);

}  // namespace karst::core
