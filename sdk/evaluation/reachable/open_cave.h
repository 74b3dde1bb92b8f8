// Finds the opening of a cave that is not closed.
#pragma once
#include "sdk/evaluation/reachable/cell_set.h"

namespace karst::evaluation {

/// On the shortest path from the start to the outermost blocks of the bounds, the first cell that has rock on
/// few sides: the hole through which the path leaves the cave. Cells of `rock` block the path; there must be
/// a path. In large empty surroundings the path ends at the first of OutsideTiles.
CellKey find_opening(const CellSet& rock, const CellKey& start);

}  // namespace karst::evaluation
