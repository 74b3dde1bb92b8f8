// Reads the point cloud of a scan: PLY, PCD or LAS.
#pragma once
#include <cstddef>
#include <string>

#include "plugins/simulator/cave/mesh_frame.h"
#include "sdk/cave_from_cloud/point_cloud.h"

namespace karst::from_cloud {

struct CloudFile {
  PointCloud cloud;
  std::size_t points = 0;  // of the file; those below are left out
  std::size_t not_finite = 0, withheld = 0, without_normal = 0;
};

/// The points of a .ply, .pcd or .las file in the frame, the offset subtracted in double precision. If most
/// points have a normal, those without one are left out; else the normals are. Throws InputError if there is
/// no point, and if points are more than 100 km from the origin, or were rounded to floats that far from it.
CloudFile read_cloud(const std::string& path, const cave::MeshFrame& frame, bool with_normals = true);

}  // namespace karst::from_cloud
