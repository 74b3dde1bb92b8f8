// The points of a scan.
#pragma once
#include <cstddef>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::from_cloud {

/// In metres with z up. Single precision suffices relative to `origin`; farther away it would not.
struct PointCloud {
  core::Vec3 origin = core::Vec3::Zero();  // a place near the points
  std::vector<core::Vec3f> points;         // less the origin
  /// One for each point, of unit length (zero where opposite ones cancelled), or none at all.
  std::vector<core::Vec3f> normals;

  bool has_normals() const { return !normals.empty(); }
};

}  // namespace karst::from_cloud
