// Polygons into a bitmap of cells.
#pragma once
#include "sdk/cave_drawing/cell_mask.h"
#include "sdk/cave_drawing/drawing.h"

namespace karst::cave_drawing {

/// The smallest convex polygon around the points, counter-clockwise (Andrew, 1979). Fewer than three points
/// if they lie on a line.
Line convex_hull(std::vector<Point> points);

/// Sets the cells whose middle is in the convex polygon, which is in units of cells.
void fill_convex(CellMask& mask, const Line& hull);

/// As fill_convex(), of a disc.
void fill_disc(CellMask& mask, const Point& middle, double radius);

}  // namespace karst::cave_drawing
