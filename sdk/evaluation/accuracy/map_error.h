// The error of a map: the distance from each of its points to the nearest point of a reference. The paper
// uses the points of a terrestrial scanner; metrics.json uses the rock surface itself, which is equivalent to
// a reference without gaps between its points.
#pragma once
#include <functional>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "sdk/evaluation/accuracy/error_statistics.h"

namespace karst::evaluation {

/// Centres of the occupied cells in the world frame, in the map's order.
std::vector<core::Vec3> occupied_centres(const core::VoxelMap& map);

/// One distance per point, metres; distances that are not finite are left out.
std::vector<double> map_errors(const std::vector<core::Vec3>& points,
                               const std::function<double(const core::Vec3&)>& distance_m);

}  // namespace karst::evaluation
