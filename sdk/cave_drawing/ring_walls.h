// The wall along an outline: thick where it was seen or measured, and uncertain where it was not.
#pragma once
#include <cstddef>
#include <functional>

#include "sdk/cave_drawing/drawing.h"

namespace karst::cave_drawing {

/// Whether the wall of a full cell is known, on this side of it (kBesideX of wall_trace.h).
using IsWallKnown = std::function<bool(int x, int y, std::size_t side)>;

/// Adds the wall along a ring of cell sides (outlines_of()), smoothed, in metres. A metre of it is known or
/// not as most of it is. Without `is_known`, all is.
void add_ring_walls(const Line& ring, double cell_m, const IsWallKnown& is_known, Drawing& drawing);

}  // namespace karst::cave_drawing
