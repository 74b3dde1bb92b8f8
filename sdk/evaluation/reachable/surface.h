// The rock surface around what of a cave can be explored, and how much of it a map holds.
#pragma once
#include <functional>

#include "sdk/evaluation/reachable/reachable.h"

namespace karst::evaluation {

/// Cells of rock that share a face with a reachable cell, each once, in a fixed order.
std::vector<CellKey> surface_cells(const Reachable& reachable);

}  // namespace karst::evaluation
