// The cells a triangle touches, and the cell centres near it.
#pragma once
#include "plugins/simulator/cave/triangle_mesh.h"
#include "sdk/evaluation/reachable/cell_set.h"

namespace karst::evaluation {

struct Triangle {
  core::Vec3 a, b, c;
};

/// Whether the triangle shares a point with the closed box. Separating axes: three box normals, the
/// triangle's normal, nine cross products of edges (Akenine-Moller, 2001). Touching counts.
bool overlaps_box(const Triangle& t, const core::Vec3& center, const core::Vec3& half);

/// Adds every cell, as a closed cube, that the triangle touches. The set's bounds must hold the triangle.
void insert_touched(CellSet& cells, const Triangle& t, double resolution_m);

/// Removes every cell whose centre is nearer than `distance_m` to the triangle.
void remove_near(CellSet& cells, const Triangle& t, double resolution_m, double distance_m);

}  // namespace karst::evaluation
