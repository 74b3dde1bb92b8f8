// A motion in closed form, with what ideal and noisy sensors would say of it.
#pragma once
#include <cmath>
#include <vector>

#include "core_stack/common/random_vector.h"
#include "core_stack/common/so3.h"
#include "sdk/preflight/vehicle/gyro_track.h"

namespace karst::test {

/// Turns about all axes by `amplitude_rad`, at three rates that have no common period.
inline core::Quat turned(double t_s, const core::Vec3& amplitude_rad = {0.5, 0.6, 0.9}) {
  return core::exp_so3(amplitude_rad.z() * std::sin(0.83 * t_s + 0.3) * core::Vec3::UnitZ()) *
         core::exp_so3(amplitude_rad.y() * std::sin(1.71 * t_s + 1.1) * core::Vec3::UnitY()) *
         core::exp_so3(amplitude_rad.x() * std::sin(1.37 * t_s) * core::Vec3::UnitX());
}

struct SyntheticImu {
  core::Vec3 bias_radps = core::Vec3::Zero();
  double rate_noise_radps = 0, force_noise_mps2 = 0;
  core::Vec3 amplitude_rad = {0.5, 0.6, 0.9};
};

/// At 200 Hz for `duration_s`: the rate by central differences over 2 ms, and gravity.
inline std::vector<core::ImuSample> imu_of_motion(double duration_s, const SyntheticImu& imu = {}) {
  std::vector<core::ImuSample> samples;
  core::Random random(5);
  for (int i = 0; i <= static_cast<int>(200 * duration_s); ++i) {
    const double t = i / 200.0, h = 1e-3;
    const core::Quat q = turned(t, imu.amplitude_rad);
    const core::Vec3 rate =
        core::log_so3(turned(t - h, imu.amplitude_rad).conjugate() * turned(t + h, imu.amplitude_rad)) /
        (2 * h);
    samples.push_back({core::from_seconds(t),
                       q.conjugate() * core::Vec3(0, 0, 9.81) + imu.force_noise_mps2 * normal_vector(random),
                       rate + imu.bias_radps + imu.rate_noise_radps * normal_vector(random)});
  }
  return samples;
}

/// Orientations at 10 Hz by a sensor whose claimed mounting is wrong by `error`, whose stamps are late by
/// `delay_s`, and whose orientations have this noise.
inline std::vector<preflight::Orientation> track_of_motion(double duration_s,
                                                           const core::Vec3& error_rad = {0, 0, 0},
                                                           double delay_s = 0, double noise_rad = 0) {
  std::vector<preflight::Orientation> track;
  core::Random random(9);
  const core::Quat error = core::exp_so3(error_rad);
  for (int i = 0; i <= static_cast<int>(10 * duration_s); ++i)
    track.push_back(
        {core::from_seconds(i / 10.0 + delay_s),
         error * turned(i / 10.0) * core::exp_so3(noise_rad * normal_vector(random)) * error.conjugate()});
  return track;
}

}  // namespace karst::test
