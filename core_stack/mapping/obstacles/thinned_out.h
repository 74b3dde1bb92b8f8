// Points thinned to one a cell.
#pragma once
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

/// One point, the mean, for each cube of `cell_m` that contains points; in the order of the cubes. Points
/// that are not finite, or too far for the cubes to be counted, are left out.
std::vector<Vec3f> thinned_out(const std::vector<Vec3f>& points, double cell_m);

}  // namespace karst::core
