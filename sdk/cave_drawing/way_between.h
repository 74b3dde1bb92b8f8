// The way from one place of a passage to the next, around the corners of rock.
#pragma once
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::cave_drawing {

/// Points not more than `step_m` apart in a straight line, if it is free; else the middles of free cells,
/// each beside the next, on a shortest way within 3 m of the straight line's box; else the straight line.
std::vector<core::Vec3> way_between(const core::VoxelMap& map, const core::Vec3& from, const core::Vec3& to,
                                    double step_m);

}  // namespace karst::cave_drawing
