#include "core_stack/localization/inertial_filter.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core_stack/common/so3.h"

namespace karst::core {
namespace {

constexpr double kGravity = 9.81;          // m/s^2
constexpr double kImuReferenceRate = 200;  // Hz, the rate for which the sample noise is specified
constexpr TimeNs kBuffer = kSecond;
constexpr TimeNs kAhead = 50 * kMillisecond;  // poses newer than the IMU by more than this are ignored
// Uncertainty at the start: the vehicle stands at a declared pose, and its biases are unknown.
constexpr double kStartPosition = 0.05, kStartVelocity = 0.05, kStartAngle = 0.02, kStartAccelBias = 0.2,
                 kStartGyroBias = 0.02;
constexpr double kRestartVelocity = 0.3;
// After a time in which nobody measured: of a second or more, at 2 m/s.
constexpr double kLostPosition = 3, kLostVelocity = 1.5, kLostTilt = 0.2, kLostHeading = 0.8;

// Indices of the blocks of the error state.
constexpr int kP = 0, kV = 3, kA = 6, kBa = 9, kBg = 12;

double squared(double v) { return v * v; }

/// Extrapolates the pose of `s` for a short time with its velocity and body rate.
Pose extrapolated(const State& s, double dt_s) {
  return {s.position + s.velocity_mps * dt_s,
          (s.orientation * exp_so3(s.body_rate_radps * dt_s)).normalized()};
}

}  // namespace

InertialFilter::InertialFilter(const InertialNoise& noise, const Pose& T_world_start) : noise_(noise) {
  later_.reserve(kUsual);
  state_.position = T_world_start.position;
  state_.orientation = T_world_start.orientation;
  Vector15 sigma;
  sigma << Vec3::Constant(kStartPosition), Vec3::Constant(kStartVelocity), Vec3::Constant(kStartAngle),
      Vec3::Constant(kStartAccelBias), Vec3::Constant(kStartGyroBias);
  covariance_ = sigma.array().square().matrix().asDiagonal();
}

/// Nominal state: trapezoidal rule over one interval; rates and forces are assumed linear between samples.
/// Error state, to first order, with R the rotation, f the force, w the rate in the body:
///   dp' = dp + dv dt,  dv' = dv - R [f]x da dt - R dba dt,  da' = exp(-w dt) da - dbg dt.
void InertialFilter::propagate(const ImuSample& before, const ImuSample& after, double noise_scale) {
  const double dt = seconds(after.stamp - before.stamp);
  const Vec3 rate = 0.5 * (before.body_rate_radps + after.body_rate_radps) - gyro_bias_radps_;
  State next;
  next.stamp = after.stamp;
  next.orientation = (state_.orientation * exp_so3(rate * dt)).normalized();
  next.body_rate_radps = after.body_rate_radps - gyro_bias_radps_;
  const Vec3 force_before = before.specific_force_mps2 - accel_bias_mps2_;
  const Vec3 force_world = 0.5 * (state_.orientation * force_before +
                                  next.orientation * (after.specific_force_mps2 - accel_bias_mps2_));
  const Vec3 acceleration = force_world - kGravity * Vec3::UnitZ();
  next.velocity_mps = state_.velocity_mps + acceleration * dt;
  next.position = state_.position + 0.5 * (state_.velocity_mps + next.velocity_mps) * dt;

  const Eigen::Matrix3d R = state_.orientation.toRotationMatrix(), I = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d force_by_angle = -R * skew(force_before);
  Matrix15 F = Matrix15::Identity();
  F.block<3, 3>(kP, kV) = I * dt;
  F.block<3, 3>(kP, kA) = 0.5 * dt * dt * force_by_angle;
  F.block<3, 3>(kP, kBa) = -0.5 * dt * dt * R;
  F.block<3, 3>(kV, kA) = dt * force_by_angle;
  F.block<3, 3>(kV, kBa) = -dt * R;
  F.block<3, 3>(kA, kA) = exp_so3(-rate * dt).toRotationMatrix();
  F.block<3, 3>(kA, kBg) = -dt * I;
  covariance_ = (F * covariance_ * F.transpose()).eval();
  const double accel_density = squared(noise_scale * noise_.accel_noise_mps2) / kImuReferenceRate;
  const double gyro_density = squared(noise_scale * noise_.gyro_noise_radps) / kImuReferenceRate;
  for (int i = 0; i < 3; ++i) {
    covariance_(kP + i, kP + i) += accel_density * dt * dt * dt / 3;
    covariance_(kP + i, kV + i) += accel_density * dt * dt / 2;
    covariance_(kV + i, kP + i) += accel_density * dt * dt / 2;
    covariance_(kV + i, kV + i) += accel_density * dt;
    covariance_(kA + i, kA + i) += gyro_density * dt;
    covariance_(kBa + i, kBa + i) += squared(noise_.accel_bias_drift_mps2) * dt;
    covariance_(kBg + i, kBg + i) += squared(noise_.gyro_bias_drift_radps) * dt;
  }
  state_ = next;
}

void InertialFilter::note(const ImuSample& imu, double noise_scale) {
  if (steps_.full()) steps_.set_capacity(2 * steps_.capacity());
  steps_.push_back({imu, noise_scale, state_, accel_bias_mps2_, gyro_bias_radps_, covariance_, {}});
  history_.push(state_);
}

void InertialFilter::on_imu(const ImuSample& imu, double noise_scale) {
  if (noise_scale <= 1) drop_predicted(imu.stamp);
  if (steps_.empty()) {
    state_.stamp = imu.stamp;
    state_.body_rate_radps = imu.body_rate_radps;
  } else {
    if (imu.stamp <= steps_.back().imu.stamp) return;
    propagate(steps_.back().imu, imu, noise_scale);
  }
  note(imu, noise_scale);
  while (steps_.front().imu.stamp < imu.stamp - kBuffer) steps_.pop_front();
}

/// Goes back to the last step before `since`, unless a measured one is newer or that step is gone.
void InertialFilter::drop_predicted(TimeNs since) {
  if (steps_.empty() || steps_.back().imu.stamp < since || steps_.front().imu.stamp >= since) return;
  std::size_t kept = steps_.size();
  for (; steps_[kept - 1].imu.stamp >= since; --kept)
    if (steps_[kept - 1].noise_scale <= 1) return;
  steps_.erase_end(steps_.size() - kept);
  go_back_to(kept - 1);
  for (const Scalar& measured : steps_.back().scalars) correct(measured);
}

/// Index of the last step that is not newer than `stamp`.
std::optional<std::size_t> InertialFilter::step_at(TimeNs stamp) const {
  if (steps_.empty() || stamp < steps_.front().imu.stamp) return std::nullopt;
  const auto after = std::upper_bound(steps_.begin(), steps_.end(), stamp,
                                      [](TimeNs t, const Step& s) { return t < s.imu.stamp; });
  return static_cast<std::size_t>(after - steps_.begin()) - 1;
}

void InertialFilter::go_back_to(std::size_t step) {
  const Step& s = steps_[step];
  state_ = s.state;
  accel_bias_mps2_ = s.accel_bias_mps2;
  gyro_bias_radps_ = s.gyro_bias_radps;
  covariance_ = s.covariance;
}

void InertialFilter::replay_after(std::size_t step) {
  later_.assign(steps_.begin() + static_cast<std::ptrdiff_t>(step), steps_.end());
  steps_.erase_end(steps_.size() - step);
  note(later_.front().imu, later_.front().noise_scale);
  for (std::size_t i = 0;; ++i) {
    for (const Scalar& measured : later_[i].scalars) on_scalar(measured);
    if (i + 1 == later_.size()) return;
    propagate(later_[i].imu, later_[i + 1].imu, later_[i + 1].noise_scale);
    note(later_[i + 1].imu, later_[i + 1].noise_scale);
  }
}

void InertialFilter::inject(const Vector15& error) {
  state_.position += error.segment<3>(kP);
  state_.velocity_mps += error.segment<3>(kV);
  state_.orientation = (state_.orientation * exp_so3(error.segment<3>(kA))).normalized();
  state_.body_rate_radps -= error.segment<3>(kBg);
  accel_bias_mps2_ += error.segment<3>(kBa);
  gyro_bias_radps_ += error.segment<3>(kBg);
}

InertialFilter::Verdict InertialFilter::on_pose(const PoseMeasurement& pose, double gate) {
  const auto step = step_at(pose.stamp);
  if (!step || pose.stamp <= last_pose_ || pose.stamp > steps_.back().imu.stamp + kAhead)
    return Verdict::ignored;
  const Step& at = steps_[*step];
  const Pose expected = extrapolated(at.state, seconds(pose.stamp - at.imu.stamp));
  Eigen::Matrix<double, 6, 1> innovation;
  innovation << pose.T_world_body.position - expected.position,
      log_so3((expected.orientation.conjugate() * pose.T_world_body.orientation).normalized());
  Eigen::Matrix<double, 6, 15> H = Eigen::Matrix<double, 6, 15>::Zero();
  H.block<3, 3>(0, kP) = H.block<3, 3>(3, kA) = Eigen::Matrix3d::Identity();
  const Matrix6 S = H * at.covariance * H.transpose() + pose.covariance;
  const Eigen::LDLT<Matrix6> inverse(S);
  if (!(innovation.dot(inverse.solve(innovation)) < gate * gate)) return Verdict::gated;

  last_pose_ = pose.stamp;
  const std::size_t from = *step;
  go_back_to(from);
  const Eigen::Matrix<double, 15, 6> K = inverse.solve(H * covariance_).transpose();
  inject(K * innovation);
  // Joseph's form keeps the covariance symmetric and positive definite.
  const Matrix15 rest = Matrix15::Identity() - K * H;
  covariance_ = (rest * covariance_ * rest.transpose() + K * pose.covariance * K.transpose()).eval();
  replay_after(from);
  return Verdict::accepted;
}

/// For the heading only the rotation about the world's z axis is corrected: dh = z . R da.
void InertialFilter::correct(const Scalar& m) {
  const bool heading = m.kind == Scalar::Kind::heading_rad;
  const double innovation =
      heading ? wrap_angle(m.value - heading_of(state_.orientation)) : m.value - state_.position.z();
  Eigen::Matrix<double, 1, 15> H = Eigen::Matrix<double, 1, 15>::Zero();
  if (heading)
    H.segment<3>(kA) = state_.orientation.toRotationMatrix().row(2);
  else
    H[kP + 2] = 1;
  const double S = (H * covariance_ * H.transpose())(0) + squared(m.sigma);
  const Vector15 K = covariance_ * H.transpose() / S;
  inject(K * innovation);
  const Matrix15 rest = Matrix15::Identity() - K * H;
  covariance_ = (rest * covariance_ * rest.transpose() + K * squared(m.sigma) * K.transpose()).eval();
}

void InertialFilter::on_scalar(const Scalar& measured) {
  if (steps_.empty()) return;
  correct(measured);
  steps_.back().scalars.push_back(measured);  // the stored state stays uncorrected: a replay starts from it
  history_.push(state_);
}

void InertialFilter::lose_track() {
  if (steps_.empty()) return;
  state_.orientation = from_heading(heading_of(state_.orientation));
  state_.velocity_mps.setZero();
  for (const int at : {kP, kV, kA}) {
    covariance_.middleRows<3>(at).setZero();
    covariance_.middleCols<3>(at).setZero();
  }
  Eigen::Matrix<double, 9, 1> sigma;
  sigma << Vec3::Constant(kLostPosition), Vec3::Constant(kLostVelocity), kLostTilt, kLostTilt, kLostHeading;
  covariance_.topLeftCorner<9, 9>() = sigma.array().square().matrix().asDiagonal();
  const ImuSample last = steps_.back().imu;
  steps_.clear();  // a pose from before tells nothing of now
  note(last, 1);
}

void InertialFilter::restart_at(const PoseMeasurement& pose) {
  const auto step = step_at(pose.stamp);
  if (!step) return;
  go_back_to(*step);
  state_.position = pose.T_world_body.position;
  state_.orientation = pose.T_world_body.orientation.normalized();
  for (const int at : {kP, kA}) {
    covariance_.middleRows<3>(at).setZero();
    covariance_.middleCols<3>(at).setZero();
  }
  covariance_.block<3, 3>(kP, kP) = pose.covariance.topLeftCorner<3, 3>();
  covariance_.block<3, 3>(kA, kA) = pose.covariance.bottomRightCorner<3, 3>();
  covariance_.block<3, 3>(kV, kV) += Eigen::Matrix3d::Identity() * squared(kRestartVelocity);
  // A bias learned while the poses were tilted turns with the body, and contradicts all poses to come.
  covariance_.block<3, 3>(kBa, kBa) += Eigen::Matrix3d::Identity() * squared(kStartAccelBias);
  last_pose_ = pose.stamp;
  replay_after(*step);
}

double InertialFilter::position_sigma_m() const {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance_.block<3, 3>(kP, kP),
                                                            Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, axes.eigenvalues().maxCoeff()));
}

double InertialFilter::heading_sigma_rad() const {
  const Vec3 z = state_.orientation.conjugate() * Vec3::UnitZ();
  return std::sqrt(std::max(0.0, z.dot(covariance_.block<3, 3>(kA, kA) * z)));
}

}  // namespace karst::core
