// The extended profile of a map: passages unrolled, so that their length and their heights are true.
//
// Vertical rays from the middle line of a passage meet its ceiling and its floor. Where it is steep,
// horizontal rays meet the walls of the shaft. Passages leave the entrance to the right, and side passages
// keep to where they branch off, to the right or to the left, unless something is drawn there already. Then
// they are moved aside, and a dashed line says from where.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "sdk/cave_drawing/drawing.h"
#include "sdk/cave_drawing/passage_lines.h"

namespace karst::cave_drawing {

struct UnrolledProfile {
  Drawing drawing;        // spaces, walls, links, and marks of ends that lead on and of moved passages
  std::vector<Point> at;  // where each place of the passages is drawn
  double length_m = 0;    // of the first strip, horizontally, from wall to wall
};

/// Heights are relative to `entrance_z_m`. Without strips the drawing is empty.
UnrolledProfile unrolled_profile(const core::VoxelMap& map, const PassageLines& lines, double entrance_z_m,
                                 const std::string& file);

}  // namespace karst::cave_drawing
