#include "core_stack/mapping/occupancy/moving_bodies.h"

#include <algorithm>

namespace karst::core {

void leave_out(std::vector<Ray>& rays, std::span<const MovingBody> bodies) {
  for (const MovingBody& body : bodies) {
    const Vec3f center = body.position.cast<float>();
    const auto reach2 = static_cast<float>(body.radius_m * body.radius_m);
    for (Ray& ray : rays)
      if (ray.hit && (ray.end - center).squaredNorm() < reach2) ray.hit = false;
  }
}

}  // namespace karst::core
