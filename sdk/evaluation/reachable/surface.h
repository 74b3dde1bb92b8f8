// The rock surface around the explorable part of a cave, and the fraction of it in a map.
#pragma once
#include <functional>

#include "sdk/evaluation/reachable/reachable.h"

namespace karst::evaluation {

/// Rock cells that share a face with a reachable cell, each once, in a fixed order.
std::vector<CellKey> surface_cells(const Reachable& reachable);

}  // namespace karst::evaluation
