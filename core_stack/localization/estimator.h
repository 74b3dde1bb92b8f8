// State estimation behind its final interface. In this version the correction is the vehicle's pose sensor.
//
// The state is propagated with every IMU sample (strap-down) and corrected by poses that arrive late: the
// correction is made at the pose's stamp in a buffer of past states, and the IMU samples since are
// replayed. Gains are those of a steady-state Kalman filter; gyroscope and accelerometer biases are estimated.
#pragma once
#include <deque>

#include "core_stack/localization/state.h"
#include "core_stack/vehicle/messages.h"

namespace karst::core {

struct EstimatorOptions {
  double position_gain = 0.2;  // share of a pose's innovation taken per correction
  double velocity_gain = 0.5;  // 1/s
  double attitude_gain = 0.2;
  double accel_bias_gain = 0.05;
  double gyro_bias_gain = 0.02;
  double pose_timeout_s = 0.5;  // health degrades without a pose for so long; lost at four times that
};
void describe(OptionTable& t, EstimatorOptions& o);

class Estimator {
 public:
  Estimator(const EstimatorOptions& options, const Pose& T_world_start);
  void on_imu(const ImuSample& imu);
  void on_pose(const PoseSample& pose);
  void on_magnetometer(const MagnetometerSample& mag);

  const State& state() const;             // at the last IMU sample
  const StateHistory& history() const;    // of the states as corrected, about 2 s, 100 Hz or more
  Health health(TimeNs now) const;
  Vec3 accel_bias_mps2() const;
  Vec3 gyro_bias_radps() const;

 private:
  // private members are the implementer's
};

}  // namespace karst::core
