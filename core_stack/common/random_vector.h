// Random vectors.
#pragma once
#include "core_stack/common/geometry.h"
#include "core_stack/common/random.h"

namespace karst::core {

/// Three independent standard normals.
inline Vec3 normal_vector(Random& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

}  // namespace karst::core
