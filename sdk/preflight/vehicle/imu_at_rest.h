// What an IMU says while the vehicle stands still.
#pragma once
#include <span>

#include "core_stack/vehicle/messages.h"

namespace karst::preflight {

struct ImuAtRest {
  int samples = 0;
  int invalid = 0;  // with a component that is not a number
  core::Vec3 mean_force_mps2 = core::Vec3::Zero(), mean_rate_radps = core::Vec3::Zero();
  double force_noise_mps2 = 0, rate_noise_radps = 0;  // standard deviation of the noisiest axis
  double force_drift_mps2 = 0;  // between the means of the first and the last third: it was moved
  double repeated = 0;          // fraction of samples equal to the one before

  double gravity_mps2() const { return mean_force_mps2.norm(); }
  /// Between the measured up and the body's z axis.
  double tilt_rad() const;
};
ImuAtRest imu_at_rest(std::span<const core::ImuSample> samples);

/// The fraction of samples in which an axis stays at the greatest value it ever has: its range is too small.
/// For samples of a motion.
double clipped_fraction(std::span<const core::ImuSample> samples);

}  // namespace karst::preflight
