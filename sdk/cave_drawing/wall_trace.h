// Edges between cells, joined to walls: polygons of known area, still with steps of one cell.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "sdk/cave_drawing/cell_mask.h"
#include "sdk/cave_drawing/drawing.h"

namespace karst::cave_drawing {

/// One side of a cell, from one corner to the next, with the free side on its left.
struct CellSide {
  int x = 0, y = 0;          // the corner where it begins
  std::uint8_t heading = 0;  // 0 right, 1 up, 2 left, 3 down
};

/// The cells beside a cell: below it, to its right, above it and to its left.
inline constexpr std::array<int, 4> kBesideX{0, 1, 0, -1}, kBesideY{-1, 0, 1, 0};
/// The side of a cell that it shares with the cell `side` of these.
CellSide side_of(int x, int y, std::uint8_t side);

/// All sides, joined where one begins and another ends; in units of cells, with a point at each corner.
/// Where two pieces touch at a corner they are kept apart. Closed lines end where they begin.
std::vector<Line> joined(const std::vector<CellSide>& sides);

/// The outlines of the full cells, counter-clockwise, and of the holes in them, clockwise. Cells that touch
/// at a corner only are not joined.
std::vector<Line> outlines_of(const CellMask& mask);

/// Positive for counter-clockwise rings; the sum over all outlines is the number of cells.
double signed_area(const Line& ring);

}  // namespace karst::cave_drawing
