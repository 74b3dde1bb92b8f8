// State estimation behind its final interface. In this version the correction is the vehicle's pose sensor.
//
// The state is propagated with every IMU sample (strap-down) and corrected by poses that arrive late: the
// correction is made at the pose's stamp in a buffer of past states, and the IMU samples since are
// replayed. Gains are a Kalman filter's: two small error models, position-velocity-accelerometer bias and
// attitude-gyroscope bias, whose covariances depend only on the times of the poses. At a steady pose rate
// they settle to constant gains (derivation and figures: docs/control.md).
#pragma once
#include <deque>
#include <limits>

#include "core_stack/localization/state.h"
#include "core_stack/vehicle/messages.h"

namespace karst::core {

struct EstimatorOptions {
  // Standard deviations. IMU noise is that of one sample at 200 Hz; the accelerometer's includes what a small
  // error of tilt and the vehicle's vibration add.
  double accel_noise_mps2 = 0.15;
  double gyro_noise_radps = 0.008;
  double accel_bias_drift_mps2 = 0.01;  // how far the bias wanders in one second
  double gyro_bias_drift_radps = 0.0005;
  double pose_position_noise_m = 0.01;
  double pose_attitude_noise_rad = 0.0035;
  double pose_timeout_s = 0.5;  // health degrades without a pose for so long; lost at four times that
};
void describe(OptionTable& t, EstimatorOptions& o);

class Estimator {
 public:
  Estimator(const EstimatorOptions& options, const Pose& T_world_start);
  /// Samples that are not finite or not newer than the last are ignored.
  void on_imu(const ImuSample& imu);
  /// Poses that are not finite, not newer than the last, or older than the history are ignored.
  void on_pose(const PoseSample& pose);
  /// Accepted and unused: the pose sensor gives heading without the bends that ore puts into the field.
  void on_magnetometer(const MagnetometerSample& mag);

  const State& state() const { return state_; }  // at the last IMU sample
  const StateHistory& history() const {
    return history_;
  }  // of the states as corrected: 2 s, every IMU sample
  /// Degraded: no pose or no IMU sample for the timeout, or an input that was not finite within it.
  Health health(TimeNs now) const;
  Vec3 accel_bias_mps2() const { return accel_bias_mps2_; }
  Vec3 gyro_bias_radps() const { return gyro_bias_radps_; }

 private:
  State propagate(const State& s, const ImuSample& before, const ImuSample& after) const;
  void predict_covariance(double dt_s);

  EstimatorOptions options_;
  State state_;
  StateHistory history_;
  std::deque<ImuSample> imu_;               // imu_[i] led to history_.states()[i]
  Vec3 accel_bias_mps2_ = Vec3::Zero();     // body frame
  Vec3 gyro_bias_radps_ = Vec3::Zero();     // body frame
  Eigen::Matrix3d translation_covariance_;  // of one axis: position, velocity, accelerometer bias
  Eigen::Matrix2d rotation_covariance_;     // of one axis: angle, gyroscope bias
  TimeNs covariance_stamp_ = 0;
  TimeNs last_pose_ = 0;
  TimeNs last_bad_input_ = std::numeric_limits<TimeNs>::min();
};

}  // namespace karst::core
