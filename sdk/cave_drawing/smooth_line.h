// Walls as a hand would draw them: without the steps of the cells, and with few points.
#pragma once
#include "sdk/cave_drawing/drawing.h"

namespace karst::cave_drawing {

/// A line along the sides of cells, in units of cells, smoothed: the middles of its sides are moved between
/// those beside them, by at most half a cell. Closed lines stay closed, the ends of others
/// stay in place.
Line smoothed(const Line& steps);

/// The fewest of its points so that none that is left out is farther than `most` from the line (Douglas and
/// Peucker, 1973).
Line simplified(const Line& line, double most);

/// Metres from cells.
Line scaled(const Line& line, double cell_m);

}  // namespace karst::cave_drawing
