#pragma once
#include "core_stack/common/geometry.h"
#include "core_stack/common/random.h"

namespace karst::sim {

/// Three independent standard normals.
inline core::Vec3 normal_vector(core::Random& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

}  // namespace karst::sim
