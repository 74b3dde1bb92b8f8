// Which free cells are seen from where a vehicle can fly.
#pragma once
#include "sdk/evaluation/reachable/cell_set.h"

namespace karst::evaluation {

/// The directions of sight, unit length: to the 26 neighbours, and 256 spread evenly over the sphere.
const std::vector<core::Vec3>& sight_directions();

/// Cells entered one after another, counted from the first, by a ray from a cell's centre; `cells` is the
/// ray's length in cell edges. Borders met at the same time are passed in the order x, y, z.
std::vector<CellKey> cells_along(const core::Vec3& direction, double cells);

/// The cells of `free` that are in `flyable`, or from which one of the sight directions leads through cells
/// of `free` only into one of `flyable` within `cells` cell edges. `flyable` is part of `free`.
CellSet seen_from(const CellSet& flyable, const CellSet& free, double cells);

}  // namespace karst::evaluation
