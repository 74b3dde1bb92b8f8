// The drawing itself as SVG elements: grid, spaces, walls, lines and marks inside a frame.
#pragma once
#include <string>

#include "sdk/cave_drawing/drawing.h"
#include "sdk/cave_drawing/sheet.h"

namespace karst::cave_drawing {

/// Spaces, a grid of this step, walls, lines, marks with their labels, and the frame.
std::string inside_frame(const Drawing& drawing, const Frame& frame, double step_m);

/// The grid's numbers in metres, to the left of the frame and below it.
std::string grid_numbers(const Frame& frame, double step_m);

/// A bar of black and white pieces from `left_top` on, with its numbers above.
std::string scale_bar(const Point& left_top, double scale, double most_mm);

/// An arrow to the north around `middle`; `turned_rad` is clockwise from up.
std::string north_arrow(const Point& middle, double turned_rad);

}  // namespace karst::cave_drawing
