// Bodies that move through the space that is mapped: other vehicles, which tell where they are or are seen.
#pragma once
#include <span>
#include <vector>

#include "core_stack/mapping/occupancy/rays.h"
#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// A ball that holds the body at the time of the rays, with all that is not known of where it is.
struct MovingBody {
  Vec3 position = Vec3::Zero();
  double radius_m = 0;
};

/// Rays that end within a body lose their hit: they show the way up to it free, and leave no ghost where it
/// was.
void leave_out(std::vector<Ray>& rays, std::span<const MovingBody> bodies);

/// What one scan shows in the air where the map had nothing: the middle of each group of returns that is no
/// larger than a vehicle and lies in cells that were free before the scan. It touches nothing larger, or only
/// what of it lies in cells that surely were free counts: noise at the rock's surface lies by the rock, and
/// what fell from the roof on the ground.
std::vector<Vec3> bodies_in_the_air(const VoxelMap& before, std::span<const Ray> rays);

}  // namespace karst::core
