// Path lengths between places through the cells of a set.
#pragma once
#include <vector>

#include "sdk/selection/cell_index.h"

namespace karst::selection {

/// For each cell the length, in cell edges, of the shortest path from `source`; infinity if there is none.
/// Paths lead from centre to centre in moves of up to two cells along each axis (98 directions), so that
/// straight paths are 2.4 % too long on average and 5 % at most.
std::vector<float> distances_from(const CellIndex& cells, std::size_t source);

/// For each cell the path length, in cell edges, to the nearest cell outside the set (26 directions): a
/// measure of the depth inside the set, not a Euclidean distance.
std::vector<float> depths(const CellIndex& cells);

}  // namespace karst::selection
