// Smooth random fields with a seed, the same on every platform.
#pragma once
#include <cstdint>

#include "core_stack/common/geometry.h"

namespace karst::cave {

/// Gradient noise (Perlin, 2002) with one feature per unit length; about -1..1, zero mean.
double gradient_noise(const core::Vec3& p, std::uint32_t seed);

/// The same in one dimension, for quantities that vary along a passage.
double gradient_noise(double s, std::uint32_t seed);

}  // namespace karst::cave
