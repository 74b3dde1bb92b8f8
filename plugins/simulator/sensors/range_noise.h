// Cheap noise for tens of thousands of ranges per scan.
#pragma once
#include "core_stack/common/random.h"

namespace karst::sim {

/// Close to a standard normal: the sum of four 16-bit uniforms out of one draw, scaled to deviation 1
/// (Irwin-Hall; it ends at 3.46 deviations, as a sensor's outlier filter would).
inline float range_noise(core::Random& random) {
  const std::uint64_t b = random.bits();
  const auto sum = static_cast<float>((b & 0xffff) + ((b >> 16) & 0xffff) + ((b >> 32) & 0xffff) + (b >> 48));
  constexpr float kMean = 2.0f * 65535.0f, kDeviation = 37837.23f;  // sqrt(4 (2^32 - 1) / 12)
  return (sum - kMean) / kDeviation;
}

}  // namespace karst::sim
