// Accelerometer and gyroscope.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "core_stack/vehicle/messages.h"

namespace karst::sim {

struct ImuOptions {
  double accelerometer_noise_mps2 = 0.05;  // standard deviation of a sample
  double accelerometer_bias_mps2 = 0.03;   // standard deviation at power-on
  double accelerometer_walk = 0.0005;      // m/s^2 a square root of a second
  double gyroscope_noise_radps = 0.003;
  double gyroscope_bias_radps = 0.002;
  double gyroscope_walk = 0.00002;  // rad/s a square root of a second
};
void describe(core::OptionTable& t, ImuOptions& o);

class Imu {
 public:
  Imu(const ImuOptions& o, core::Random random);

  /// True mean specific force and body rate over the last `dt_s`, with bias and noise.
  core::ImuSample sample(core::TimeNs stamp, const core::Vec3& specific_force_mps2,
                         const core::Vec3& body_rate_radps, double dt_s);
  core::Vec3 gyroscope_bias_radps() const { return gyroscope_bias_; }

 private:
  ImuOptions options_;
  core::Random random_;
  core::Vec3 accelerometer_bias_, gyroscope_bias_;
};

}  // namespace karst::sim
