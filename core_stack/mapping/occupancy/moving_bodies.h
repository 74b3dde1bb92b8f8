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

/// Bodies that one scan shows where the map had free space: the mean of each group of returns that is no
/// larger than a vehicle, touches nothing larger beside it, and lies in part in cells that were surely free
/// before. A small piece of rock that a wrong pose moves into the open counts as well: a body must be seen to
/// move (seen_vehicles.h).
std::vector<Vec3> bodies_in_the_air(const VoxelMap& before, std::span<const Ray> rays);

}  // namespace karst::core
