// Units of the IMUs inside LiDARs, and what is taken for damage.
#pragma once
#include "core_stack/vehicle/messages.h"

namespace karst::lidar {

constexpr double kStandardGravity_mps2 = 9.80665;  // the unit g of both makers

/// Whether an IMU can measure these values; false for NaN.
inline bool is_plausible(const core::ImuSample& s) {
  constexpr double kMaxForce_mps2 = 1000, kMaxRate_radps = 200;
  return s.specific_force_mps2.norm() < kMaxForce_mps2 && s.body_rate_radps.norm() < kMaxRate_radps;
}

/// Stamps from here on (146 years after the clock's zero) are taken for damage.
constexpr std::uint64_t kEndOfTime_ns = std::uint64_t{1} << 62;

}  // namespace karst::lidar
