// The error of a map: for each of its points the distance to the nearest point of a reference. The paper
// measures to the points of a terrestrial scanner; metrics.json to the rock surface itself, which is the same
// for a reference without gaps between its points.
#pragma once
#include <functional>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "sdk/evaluation/accuracy/error_statistics.h"

namespace karst::evaluation {

/// Centres of the occupied cells, in the map's order.
std::vector<core::Vec3> occupied_centres(const core::VoxelMap& map);

/// A distance for each point, metres; those that are not finite are left out.
std::vector<double> map_errors(const std::vector<core::Vec3>& points,
                               const std::function<double(const core::Vec3&)>& distance_m);

}  // namespace karst::evaluation
