// The projected profile of a map: its free space seen from the side.
#pragma once
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"
#include "sdk/cave_drawing/drawing.h"
#include "sdk/cave_drawing/free_runs.h"

namespace karst::cave_drawing {

/// The horizontal unit vector of a bearing, clockwise from north.
Point direction_of(double bearing_rad);

/// The bearing, from 0 to less than pi, along which points lie the farthest from each other, to a degree.
double longest_bearing(const std::vector<Point>& points);
double longest_bearing(const FreeRuns& free);

/// Along the bearing from the entrance on, and height above it.
Point projected(const core::Vec3& p, const core::Vec3& entrance, double bearing_rad);

/// Spaces and walls, without marks. With the map, walls are uncertain where it has no rock beside the free
/// cells.
Drawing projected_profile(const FreeRuns& free, const core::Vec3& entrance, double bearing_rad,
                          const std::string& file, const core::VoxelMap* map = nullptr);

}  // namespace karst::cave_drawing
