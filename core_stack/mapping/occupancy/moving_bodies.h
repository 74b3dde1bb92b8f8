// Bodies that move through the space that is mapped: other vehicles, which tell where they are.
#pragma once
#include <span>
#include <vector>

#include "core_stack/mapping/occupancy/rays.h"

namespace karst::core {

/// A ball that holds the body at the time of the rays, with all that is not known of where it is.
struct MovingBody {
  Vec3 position = Vec3::Zero();
  double radius_m = 0;
};

/// Rays that end within a body lose their hit: they show the way up to it free, and leave no ghost where it
/// was.
void leave_out(std::vector<Ray>& rays, std::span<const MovingBody> bodies);

}  // namespace karst::core
