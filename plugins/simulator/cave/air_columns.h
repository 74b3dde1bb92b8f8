// Vertical lines of air from floor to roof, at places spread over a cave.
#pragma once
#include <vector>

#include "plugins/simulator/cave/ray_scene.h"

namespace karst::cave {

struct AirColumn {
  core::Vec3 floor = core::Vec3::Zero();
  double height_m = 0;  // to the roof
};

/// Columns through `lines` vertical lines that pass through rock surfaces, spread evenly over the surfaces'
/// area as seen from above; the same for the same mesh. Air is what lies between an odd crossing of a surface
/// and the next, counted from below; a line that crosses an odd number of them passes a hole and is left out.
std::vector<AirColumn> air_columns(const RayScene& scene, int lines);

}  // namespace karst::cave
