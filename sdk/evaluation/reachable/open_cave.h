// Where an open cave is open.
#pragma once
#include "sdk/evaluation/reachable/cell_set.h"

namespace karst::evaluation {

/// On the shortest way from the start to the outermost blocks of the bounds, the first cell that rock
/// surrounds on few sides: the hole through which the way leads out. Cells of `rock` bar the way; there must
/// be one.
CellKey find_opening(const CellSet& rock, const CellKey& start);

}  // namespace karst::evaluation
