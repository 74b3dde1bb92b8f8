// The plan of a map: the outline of its free space from above, the walls of passages that cross above others,
// and those of what they hide.
#pragma once
#include <string>

#include "sdk/cave_drawing/cell_mask.h"
#include "sdk/cave_drawing/drawing.h"
#include "sdk/cave_drawing/free_runs.h"
#include "sdk/cave_drawing/ring_walls.h"

namespace karst::cave_drawing {

/// The columns that have a free cell.
CellMask mask_from_above(const FreeRuns& free, const std::string& file);

/// Spaces, walls and hidden walls of a plan, without marks. With the map, walls are uncertain where it has no
/// rock beside the free cells.
Drawing plan_of(const FreeRuns& free, const std::string& file, const core::VoxelMap* map = nullptr);

/// Outlines of a mask, smoothed, in metres; what is too small to be a wall is left out.
void draw_mask(const CellMask& mask, double cell_m, Drawing& drawing, const IsWallKnown& is_known = {});

/// A wall is known if the cell beside it is in `rock`, or the one behind that. `rock` must outlive it.
IsWallKnown known_by(const CellMask& rock);

}  // namespace karst::cave_drawing
