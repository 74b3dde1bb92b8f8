#include "plugins/simulator/imu.h"

#include <cmath>

#include "plugins/simulator/random_vector.h"

namespace karst::sim {

using core::Vec3;

void describe(core::OptionTable& t, ImuOptions& o) {
  t.add("accelerometer_noise", o.accelerometer_noise_mps2, "m/s^2", 0, 5, "standard deviation of a sample");
  t.add("accelerometer_bias", o.accelerometer_bias_mps2, "m/s^2", 0, 2,
        "standard deviation of the bias at power-on");
  t.add("accelerometer_walk", o.accelerometer_walk, "m/s^2/sqrt(s)", 0, 1, "random walk of the bias");
  t.add("gyroscope_noise", o.gyroscope_noise_radps, "rad/s", 0, 1, "standard deviation of a sample");
  t.add("gyroscope_bias", o.gyroscope_bias_radps, "rad/s", 0, 0.5,
        "standard deviation of the bias at power-on");
  t.add("gyroscope_walk", o.gyroscope_walk, "rad/s/sqrt(s)", 0, 0.1, "random walk of the bias");
}

Imu::Imu(const ImuOptions& o, core::Random random) : options_(o), random_(random) {
  accelerometer_bias_ = o.accelerometer_bias_mps2 * normal_vector(random_);
  gyroscope_bias_ = o.gyroscope_bias_radps * normal_vector(random_);
}

core::ImuSample Imu::sample(core::TimeNs stamp, const Vec3& specific_force_mps2, const Vec3& body_rate_radps,
                            double dt_s) {
  accelerometer_bias_ += options_.accelerometer_walk * std::sqrt(dt_s) * normal_vector(random_);
  gyroscope_bias_ += options_.gyroscope_walk * std::sqrt(dt_s) * normal_vector(random_);
  core::ImuSample s{stamp, specific_force_mps2 + accelerometer_bias_, body_rate_radps + gyroscope_bias_};
  s.specific_force_mps2 += options_.accelerometer_noise_mps2 * normal_vector(random_);
  s.body_rate_radps += options_.gyroscope_noise_radps * normal_vector(random_);
  return s;
}

}  // namespace karst::sim
