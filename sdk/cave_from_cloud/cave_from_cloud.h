// From the point cloud of a real cave to a closed mesh to fly in.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "plugins/simulator/cave/cave.h"
#include "sdk/cave_from_cloud/cloud_report.h"

namespace karst::from_cloud {

struct CloudOptions {
  double resolution_m = 0;        // of the surface; 0: twice the spacing of the points, 0.1 m at least
  double guessed_beyond_m = 0;    // surface farther from all points is guessed; 0: twice the resolution
  double cap_limit_m = 20;        // diameter of the widest hole that is closed
  bool file_normals = true;       // use those of the file, if it has any
  std::vector<core::Vec3> views;  // places of the scanner, in the cloud's own coordinates
  std::optional<cave::StartPose> start;  // metres, z up; none: one that suits
};

struct CaveFromCloud {
  cave::TriangleMesh mesh;               // closed, metres, z up; the triangles face the air
  std::optional<cave::StartPose> start;  // none: no place was found that suits
  CloudReport report;
};

/// Calls `progress(step, fraction done)` as it goes on. Throws core::InputError naming `path` if the cloud
/// cannot be read, or gives no closed cave. The same for the same input. Needs has_poisson().
CaveFromCloud cave_from_cloud(const std::string& path, const cave::MeshFrame& frame,
                              const CloudOptions& options,
                              const std::function<void(const char*, double)>& progress = {});

}  // namespace karst::from_cloud
