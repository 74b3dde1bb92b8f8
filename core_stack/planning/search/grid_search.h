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

/// Octile length of a displacement in cells: the cost of the cheapest lattice way between two cells in free
/// space.
double octile_cells(const Vec3& displacement);

/// Shortest way through clear cells from any of `starts` to any of `goals`, at most `weight` times longer
/// than the best; ends count with their octile distance to `from` and `to` (in cells, centres at whole
/// numbers). Tiles of `free` are read from the map as the search gets there.
GridSearchResult search_grid(const VoxelMap& map, FreeTiles& free, const ClearanceRule& rule,
                             const std::vector<CellKey>& starts, const Vec3& from,
                             const std::vector<CellKey>& goals, const Vec3& to, double weight,
                             std::int64_t max_expansions);

}  // namespace karst::core
