// The points of a cloud that the surface is to run through, and its resolution.
#pragma once
#include <string>

#include "sdk/cave_from_cloud/cloud_report.h"
#include "sdk/cave_from_cloud/point_cloud.h"

namespace karst::from_cloud {

/// The cloud thinned out to the resolution, without lonely points. A resolution that is not given (0) is
/// chosen: from the spacing of the points, and so that the octree of the reconstruction holds the cave. Fills
/// in the report. Throws core::InputError naming `path` if the cloud is too long for a given resolution, or
/// leaves too few points.
PointCloud usable_points(const std::string& path, const PointCloud& cloud, double given_m,
                         CloudReport& report);

}  // namespace karst::from_cloud
