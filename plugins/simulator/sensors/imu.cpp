#include "plugins/simulator/sensors/imu.h"

#include <cmath>
#include <numbers>

#include "core_stack/common/random_vector.h"

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
  t.add("vibration", o.vibration_mps2, "m/s^2", 0, 100,
        "of the rotors, root mean square of each axis of the accelerometer");
  t.add("gyroscope_vibration", o.gyroscope_vibration_radps, "rad/s", 0, 10, "the same of the gyroscope");
  t.add("rotor_rate", o.rotor_hz, "Hz", 1, 1000,
        "turns a second; above 100 Hz it is seen mirrored at that, as samples come at 200 Hz");
}

Imu::Imu(const ImuOptions& o, core::Random random, core::Random vibration) : options_(o), random_(random) {
  accelerometer_bias_ = o.accelerometer_bias_mps2 * normal_vector(random_);
  gyroscope_bias_ = o.gyroscope_bias_radps * normal_vector(random_);
  const auto phases = [&vibration] {
    const double x = vibration.uniform(), y = vibration.uniform(), z = vibration.uniform();
    return Vec3(2 * std::numbers::pi * Vec3(x, y, z));
  };
  for (Rotor& r : rotors_) {
    r.rate_radps = 2 * std::numbers::pi * o.rotor_hz * vibration.uniform(0.96, 1.04);
    r.force_phase = phases();
    r.rate_phase = phases();
  }
}

core::ImuSample Imu::sample(core::TimeNs stamp, const Vec3& specific_force_mps2, const Vec3& body_rate_radps,
                            double dt_s, bool rotors_turn) {
  accelerometer_bias_ += options_.accelerometer_walk * std::sqrt(dt_s) * normal_vector(random_);
  gyroscope_bias_ += options_.gyroscope_walk * std::sqrt(dt_s) * normal_vector(random_);
  core::ImuSample s{stamp, specific_force_mps2 + accelerometer_bias_, body_rate_radps + gyroscope_bias_};
  s.specific_force_mps2 += options_.accelerometer_noise_mps2 * normal_vector(random_);
  s.body_rate_radps += options_.gyroscope_noise_radps * normal_vector(random_);
  if (rotors_turn && (options_.vibration_mps2 > 0 || options_.gyroscope_vibration_radps > 0)) {
    const double amplitude = std::sqrt(2.0 / static_cast<double>(rotors_.size()));  // of a sine of unit power
    for (const Rotor& r : rotors_) {
      const double turned = r.rate_radps * core::seconds(stamp);
      const auto wave = [&](const Vec3& phase) {
        return Vec3(amplitude * (phase.array() + turned).sin().matrix());
      };
      s.specific_force_mps2 += options_.vibration_mps2 * wave(r.force_phase);
      s.body_rate_radps += options_.gyroscope_vibration_radps * wave(r.rate_phase);
    }
  }
  return s;
}

}  // namespace karst::sim
