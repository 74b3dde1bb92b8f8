// A middle line made exact: points every half a metre, each between the walls and between floor and ceiling.
#pragma once
#include <array>
#include <vector>

#include "sdk/survey_export/middle_line.h"

namespace karst::survey_export {

/// Moves points across the line until they are in the middle, and measures width and height there. Where a
/// side passage opens, the other wall counts alone. A sharp bend becomes one point, where the axes before and
/// after it meet, and a free end that turns aside into a corner of the passage is cut off. `coarse`: points a
/// few metres apart, in free cells. `free_end`: whether the first and the last point may move across the line
/// as well.
std::vector<LinePoint> refined_line(const core::VoxelMap& map, const std::vector<LinePoint>& coarse,
                                    std::array<bool, 2> free_end);

}  // namespace karst::survey_export
