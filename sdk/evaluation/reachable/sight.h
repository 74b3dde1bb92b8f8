// Free cells that are visible from where a vehicle can fly.
#pragma once
#include "sdk/evaluation/reachable/cell_set.h"

namespace karst::evaluation {

/// The directions of sight as unit vectors: to the 26 neighbours, and 256 spread evenly over the sphere.
const std::vector<core::Vec3>& sight_directions();

/// The sequence of cells that a ray from a cell's centre enters, relative to that cell; `cells` is the ray's
/// length in cell edges. Borders met simultaneously are passed in the order x, y, z.
std::vector<CellKey> cells_along(const core::Vec3& direction, double cells);

/// The cells of `free` that are in `flyable`, or from which one of the sight directions leads through cells
/// of `free` only to a cell of `flyable` within `cells` cell edges. `flyable` must be a subset of `free`,
/// block by block and cell by cell, and have its bounds.
CellSet seen_from(const CellSet& flyable, const CellSet& free, double cells);

}  // namespace karst::evaluation
