// Fewer points: evenly spaced ones, without those that belong to no surface.
#pragma once
#include <cstddef>

#include "sdk/cave_from_cloud/point_cloud.h"

namespace karst::from_cloud {

/// Coordinates of a cloud that is thinned must be below this many voxels.
constexpr double kMostVoxels = 1e6;

/// For each voxel that holds points, their mean and their mean normal; in the order in which the cloud comes
/// upon the voxels.
PointCloud thinned(const PointCloud& cloud, double voxel_m);

/// Without groups of fewer than `least` points that are farther than `gap_m` from all others: dust, stray
/// returns, people.
PointCloud without_lonely(const PointCloud& cloud, double gap_m, std::size_t least);

/// How far points are apart: the median, over a sample, of the distance to the fourth nearest other point.
/// Points nearer to each other than 5 cm count as one.
double spacing_m(const PointCloud& cloud);

}  // namespace karst::from_cloud
