// Accelerometer and gyroscope: white noise, a bias drawn at power-on that then walks, and the rotors'
// vibration. Figures are those of a MEMS unit sampled at 200 Hz, i.e. a bandwidth of 100 Hz:
//
//                           ICM-20948 (DS-000189)                    ADIS16470             here
//   accelerometer noise     230 ug/sqrt(Hz): 0.023 m/s^2             0.1 mg/sqrt(Hz)       0.05 m/s^2
//   gyroscope noise         0.015 (deg/s)/sqrt(Hz): 0.0026 rad/s     0.008: 0.0014 rad/s   0.003 rad/s
//   accelerometer bias      +-25 mg as delivered, calibrated down to a few mg              3 mg
//   gyroscope bias          +-5 deg/s as delivered, averaged away while it stands          0.1 deg/s
//
// The accelerometer's noise here is twice that of the unit, to include the mounting. Vibration is off by
// default: 3 m/s^2 and 0.02 rad/s are typical of a vehicle in good order (ArduPilot's manual calls up to
// 15 m/s^2 normal and 30 m/s^2 too much).
#pragma once
#include <array>

#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "core_stack/vehicle/messages.h"

namespace karst::sim {

struct ImuOptions {
  double accelerometer_noise_mps2 = 0.05;  // standard deviation of a sample
  double accelerometer_bias_mps2 = 0.03;   // standard deviation at power-on
  double accelerometer_walk = 0.0005;      // m/s^2 per square root of a second
  double gyroscope_noise_radps = 0.003;
  double gyroscope_bias_radps = 0.002;
  double gyroscope_walk = 0.00002;                           // rad/s per square root of a second
  double vibration_mps2 = 0, gyroscope_vibration_radps = 0;  // root mean square of each axis, in flight
  double rotor_hz = 105;
};
void describe(core::OptionTable& t, ImuOptions& o);

class Imu {
 public:
  /// `vibration` is a separate stream for the rotors' speeds and phases.
  Imu(const ImuOptions& o, core::Random random, core::Random vibration = core::Random(0));

  /// Sample from the true mean specific force and body rate over the last `dt_s` (body frame), with bias and
  /// noise, and the vibration of this instant if the rotors turn.
  core::ImuSample sample(core::TimeNs stamp, const core::Vec3& specific_force_mps2,
                         const core::Vec3& body_rate_radps, double dt_s, bool rotors_turn = false);
  core::Vec3 gyroscope_bias_radps() const { return gyroscope_bias_; }

 private:
  ImuOptions options_;
  core::Random random_;
  core::Vec3 accelerometer_bias_, gyroscope_bias_;
  /// One rotor shakes each axis at its own rate; four that differ by a few percent beat against each other.
  struct Rotor {
    double rate_radps = 0;
    core::Vec3 force_phase = core::Vec3::Zero(), rate_phase = core::Vec3::Zero();
  };
  std::array<Rotor, 4> rotors_;
};

}  // namespace karst::sim
