#include "core_stack/localization/estimator.h"

#include <algorithm>

namespace karst::core {
namespace {

constexpr double kGravity = 9.81;          // m/s^2
constexpr double kImuReferenceRate = 200;  // Hz, at which the options' noise of one sample is meant
// Uncertainty at the start: the vehicle stands at a declared pose, its biases are unknown.
constexpr double kStartPosition = 0.05, kStartVelocity = 0.05, kStartAccelBias = 0.2;
constexpr double kStartAngle = 0.02, kStartGyroBias = 0.02;

double squared(double v) { return v * v; }

Quat exp_so3(const Vec3& rotation) {
  const double angle = rotation.norm();
  if (angle < 1e-9) return Quat(1, rotation.x() / 2, rotation.y() / 2, rotation.z() / 2).normalized();
  return Quat(Eigen::AngleAxisd(angle, rotation / angle));
}

Vec3 log_so3(const Quat& q) {
  const Eigen::AngleAxisd r(q);  // angle in [0, pi]
  return r.angle() * r.axis();
}

/// Pose a little after `s`, on its velocity and rate.
Pose extrapolated(const State& s, double dt_s) {
  return {s.position + s.velocity_mps * dt_s,
          (s.orientation * exp_so3(s.body_rate_radps * dt_s)).normalized()};
}

}  // namespace

void describe(OptionTable& t, EstimatorOptions& o) {
  t.add("accel_noise", o.accel_noise_mps2, "m/s^2", 1e-3, 5.0,
        "standard deviation of one accelerometer sample at 200 Hz, with vibration and tilt error");
  t.add("gyro_noise", o.gyro_noise_radps, "rad/s", 1e-5, 1.0,
        "standard deviation of one gyroscope sample at 200 Hz");
  t.add("accel_bias_drift", o.accel_bias_drift_mps2, "m/s^2", 1e-5, 1.0,
        "how far the accelerometer's bias wanders in one second");
  t.add("gyro_bias_drift", o.gyro_bias_drift_radps, "rad/s", 1e-6, 0.1,
        "how far the gyroscope's bias wanders in one second");
  t.add("pose_position_noise", o.pose_position_noise_m, "m", 1e-4, 1.0,
        "standard deviation of a pose's position, each axis");
  t.add("pose_attitude_noise", o.pose_attitude_noise_rad, "rad", 1e-5, 0.5,
        "standard deviation of a pose's attitude, each axis");
  t.add("pose_timeout", o.pose_timeout_s, "s", 0.05, 10.0,
        "without a pose for so long health is degraded, for four times that it is lost");
}

Estimator::Estimator(const EstimatorOptions& options, const Pose& T_world_start) : options_(options) {
  state_.position = T_world_start.position;
  state_.orientation = T_world_start.orientation;
  translation_covariance_ =
      Vec3(squared(kStartPosition), squared(kStartVelocity), squared(kStartAccelBias)).asDiagonal();
  rotation_covariance_ = Eigen::Vector2d(squared(kStartAngle), squared(kStartGyroBias)).asDiagonal();
}

/// Trapezoid rule over one IMU interval: rates and forces are taken as linear between samples.
State Estimator::propagate(const State& s, const ImuSample& before, const ImuSample& after) const {
  const double dt = seconds(after.stamp - before.stamp);
  const Vec3 rate = 0.5 * (before.body_rate_radps + after.body_rate_radps) - gyro_bias_radps_;
  State next;
  next.stamp = after.stamp;
  next.orientation = (s.orientation * exp_so3(rate * dt)).normalized();
  next.body_rate_radps = after.body_rate_radps - gyro_bias_radps_;
  const Vec3 force_world = 0.5 * (s.orientation * (before.specific_force_mps2 - accel_bias_mps2_) +
                                  next.orientation * (after.specific_force_mps2 - accel_bias_mps2_));
  const Vec3 acceleration = force_world - kGravity * Vec3::UnitZ();
  next.velocity_mps = s.velocity_mps + acceleration * dt;
  next.position = s.position + 0.5 * (s.velocity_mps + next.velocity_mps) * dt;
  return next;
}

void Estimator::on_imu(const ImuSample& imu) {
  if (!imu.specific_force_mps2.allFinite() || !imu.body_rate_radps.allFinite()) {
    last_bad_input_ = imu.stamp;
    return;
  }
  if (imu_.empty()) {
    state_.stamp = covariance_stamp_ = last_pose_ = imu.stamp;
    state_.body_rate_radps = imu.body_rate_radps;
  } else {
    if (imu.stamp <= imu_.back().stamp) return;
    state_ = propagate(state_, imu_.back(), imu);
  }
  imu_.push_back(imu);
  history_.push(state_);
  while (imu_.size() > history_.states().size()) imu_.pop_front();
}

/// Errors of one axis. Translation: white noise q on acceleration, bias b walking at density d:
///   F = [1 dt -dt^2/2; 0 1 -dt; 0 0 1].  Rotation: F = [1 -dt; 0 1].
void Estimator::predict_covariance(double dt) {
  const double accel_density = squared(options_.accel_noise_mps2) / kImuReferenceRate;
  const double gyro_density = squared(options_.gyro_noise_radps) / kImuReferenceRate;
  Eigen::Matrix3d F;
  F << 1, dt, -dt * dt / 2, 0, 1, -dt, 0, 0, 1;
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
  Q(0, 0) = accel_density * dt * dt * dt / 3;
  Q(0, 1) = Q(1, 0) = accel_density * dt * dt / 2;
  Q(1, 1) = accel_density * dt;
  Q(2, 2) = squared(options_.accel_bias_drift_mps2) * dt;
  translation_covariance_ = F * translation_covariance_ * F.transpose() + Q;
  Eigen::Matrix2d G;
  G << 1, -dt, 0, 1;
  rotation_covariance_ = G * rotation_covariance_ * G.transpose();
  rotation_covariance_(0, 0) += gyro_density * dt;
  rotation_covariance_(1, 1) += squared(options_.gyro_bias_drift_radps) * dt;
}

void Estimator::on_pose(const PoseSample& pose) {
  const Quat& q = pose.T_world_body.orientation;
  if (!pose.T_world_body.position.allFinite() || !q.coeffs().allFinite() || q.norm() < 0.5) {
    last_bad_input_ = pose.stamp;
    return;
  }
  const auto& states = history_.states();
  if (states.empty() || pose.stamp < states.front().stamp || pose.stamp <= covariance_stamp_) return;
  const auto after = std::upper_bound(states.begin(), states.end(), pose.stamp,
                                      [](TimeNs t, const State& s) { return t < s.stamp; });
  const auto first = static_cast<std::size_t>(after - states.begin()) - 1;
  State corrected = states[first];  // less than one IMU period before the pose

  const Pose predicted = extrapolated(corrected, seconds(pose.stamp - corrected.stamp));
  const Vec3 position_error = pose.T_world_body.position - predicted.position;             // world
  const Vec3 angle_error = log_so3((predicted.orientation.conjugate() * q).normalized());  // body

  predict_covariance(seconds(pose.stamp - covariance_stamp_));
  covariance_stamp_ = last_pose_ = pose.stamp;
  const Vec3 k = translation_covariance_.col(0) /
                 (translation_covariance_(0, 0) + squared(options_.pose_position_noise_m));
  const Eigen::Vector2d l =
      rotation_covariance_.col(0) / (rotation_covariance_(0, 0) + squared(options_.pose_attitude_noise_rad));
  translation_covariance_ -= k * translation_covariance_.row(0).eval();
  rotation_covariance_ -= l * rotation_covariance_.row(0).eval();

  corrected.position += k[0] * position_error;
  corrected.velocity_mps += k[1] * position_error;
  accel_bias_mps2_ += k[2] * (corrected.orientation.conjugate() * position_error);
  corrected.orientation = (corrected.orientation * exp_so3(l[0] * angle_error)).normalized();
  gyro_bias_radps_ += l[1] * angle_error;
  corrected.body_rate_radps = imu_[first].body_rate_radps - gyro_bias_radps_;

  state_ = corrected;
  history_.push(state_);
  for (std::size_t i = first + 1; i < imu_.size(); ++i) {
    state_ = propagate(state_, imu_[i - 1], imu_[i]);
    history_.push(state_);
  }
}

void Estimator::on_magnetometer(const MagnetometerSample&) {}

Health Estimator::health(TimeNs now) const {
  const TimeNs timeout = from_seconds(options_.pose_timeout_s);
  const TimeNs silence = now - std::min(last_pose_, state_.stamp);
  if (silence > 4 * timeout) return Health::lost;
  const bool bad_input = last_bad_input_ > now - timeout;
  return silence > timeout || bad_input ? Health::degraded : Health::good;
}

}  // namespace karst::core
