#include "core_stack/localization/estimator.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace karst::core {
namespace {

using Scalar = InertialFilter::Scalar;

/// Consecutive refused poses that start the newcomer filter; consecutive poses it must accept to replace the
/// other filters: 1 s at 10 Hz.
constexpr int kDoubt = 3, kSettled = 10;
/// Consecutive poses refused by the magnetic filter alone, after which the compass counts as misleading.
constexpr int kMisled = 3;
/// Heading spread of the LiDAR filter above which the compass is believed, and below which it no longer is.
constexpr double kHeadingOpen_rad = 0.02, kHeadingKnown_rad = 0.01;
constexpr double kCompassTrusted_s = 2;
/// The barometer is calibrated while the standard deviation of the height is below this.
constexpr double kHeightKnown_m = 0.03;
/// Headings and heights are applied at the current time: samples older than this are not used.
constexpr TimeNs kStale = 200 * kMillisecond;
/// Between two samples of an IMU of 100 Hz or more, of which one may be lost.
constexpr TimeNs kNoneMissing = 25 * kMillisecond;
/// So much time without a sample hides a motion.
constexpr TimeNs kLeap = 300 * kMillisecond;
/// Factor on the noise of samples predicted from the commands. They include neither the wind (0.75 m/s^2 by
/// drag in a gust of 5 m/s) nor the lag of the rates behind the command (0.25 rad/s while a turn begins), and
/// both persist from one pose to the next: 0.07 m/s and 0.025 rad in 0.1 s, which this noise covers with 0.2
/// m/s and 0.01 rad. With a smaller factor the predicted samples would overrule the LiDAR.
constexpr double kBridgeNoise = 60;
/// The same if another steers: turns of 1.5 rad/s and accelerations of 3 m/s^2 are 0.15 rad and 0.3 m/s in
/// 0.1 s, which this covers with 0.1 rad and 2 m/s. The poses of the LiDAR alone tell then where it is.
constexpr double kAnotherSteersNoise = 600;

// Standard deviations above which health is degraded, and above which it is lost.
constexpr double kPositionDegraded_m = 0.4, kPositionLost_m = 1.5, kHeadingDegraded_rad = 0.25;

bool is_finite(const ImuSample& s) {
  return s.specific_force_mps2.allFinite() && s.body_rate_radps.allFinite();
}
bool is_finite(const Pose& p) {
  return p.position.allFinite() && p.orientation.coeffs().allFinite() && p.orientation.norm() > 0.5;
}

/// Adds the sensor's biases to a predicted sample; the learnt mass already contains the bias along z.
void stand_in(InertialFilter& filter, ImuSample sample, double noise) {
  sample.specific_force_mps2.head<2>() += filter.accel_bias_mps2().head<2>();
  sample.body_rate_radps += filter.gyro_bias_radps();
  filter.on_imu(sample, noise);
}

}  // namespace

void describe(OptionTable& t, EstimatorOptions& o) {
  t.add("accel_noise", o.imu.accel_noise_mps2, "m/s^2", 1e-3, 5.0,
        "standard deviation of one accelerometer sample at 200 Hz, with vibration and tilt error");
  t.add("gyro_noise", o.imu.gyro_noise_radps, "rad/s", 1e-5, 1.0,
        "standard deviation of one gyroscope sample at 200 Hz");
  t.add("accel_bias_drift", o.imu.accel_bias_drift_mps2, "m/s^2", 1e-5, 1.0,
        "how far the accelerometer's bias wanders in one second");
  t.add("gyro_bias_drift", o.imu.gyro_bias_drift_radps, "rad/s", 1e-6, 0.1,
        "how far the gyroscope's bias wanders in one second");
  t.add("pose_position_noise", o.pose_position_noise_m, "m", 1e-4, 1.0,
        "standard deviation of a pose's position, each axis; of the LiDAR's on top of its own covariance");
  t.add("pose_attitude_noise", o.pose_attitude_noise_rad, "rad", 1e-5, 0.5,
        "standard deviation of a pose's attitude, each axis; of the LiDAR's on top of its own covariance");
  t.add("compass_noise", o.compass_noise_rad, "rad", 0.01, 3.0,
        "standard deviation of the heading by one magnetometer sample");
  // With much less noise the barometer alone would make the height look known, and calibrate itself.
  t.add("height_noise", o.height_noise_m, "m", 0.3, 100,
        "standard deviation of the height by one barometer sample");
  t.add("gate", o.gate, "", 3, 100, "poses off by so many standard deviations are refused");
  t.add("pose_timeout", o.pose_timeout_s, "s", 0.05, 10.0,
        "without a pose accepted for so long health is degraded, for four times that it is lost");
}

Estimator::Estimator(const EstimatorOptions& options, const Pose& T_world_start)
    : options_(options), lidar_(options.imu, T_world_start), magnetic_(options.imu, T_world_start) {}

void Estimator::on_imu(const ImuSample& imu) {
  if (!is_finite(imu)) {
    last_bad_input_ = imu.stamp;
    return;
  }
  if (lidar_.started() && imu.stamp <= last_imu_) return;
  if (!lidar_.started()) last_pose_ = imu.stamp;
  const TimeNs missing = imu.stamp - last_imu_;
  const bool guessed = guessed_until_ > last_imu_;
  // Neither the IMU nor a prediction, or only a guess without a pose, tells what was flown.
  const bool unseen = lidar_.started() && (imu.stamp - state().stamp > kLeap ||
                                           (guessed && missing > kLeap && last_pose_ <= last_imu_));
  lidar_.on_imu(imu);
  magnetic_.on_imu(imu);
  if (newcomer_) newcomer_->on_imu(imu);
  if (state().stamp != imu.stamp) return;  // too old to take the place of what was predicted for its time
  last_imu_ = imu.stamp;
  if (unseen) {
    lose_track();
  } else if (guessed) {
    guessed_until_ = imu.stamp;
    if (missing <= kNoneMissing) poses_since_guess_ = before_guess_;  // it comes late: nothing was guessed
  }
}

void Estimator::lose_track() {
  if (!lidar_.started()) return;
  lidar_.lose_track();
  magnetic_.lose_track();
  newcomer_.reset();
  refused_ = 0;
  track_lost_at_ = guessed_until_ = state().stamp;
  poses_since_guess_ = before_guess_ = 0;
}

void Estimator::bridge(const ImuSample& expected, Expected how) {
  if (!lidar_.started() || !is_finite(expected) || expected.stamp <= state().stamp) return;
  const double noise = how == Expected::as_commanded ? kBridgeNoise : kAnotherSteersNoise;
  if (how == Expected::another_steers) {
    if (guessed_until_ <= last_imu_) before_guess_ = poses_since_guess_;
    guessed_until_ = expected.stamp;
    poses_since_guess_ = 0;
  }
  stand_in(lidar_, expected, noise);
  stand_in(magnetic_, expected, noise);
  if (newcomer_) stand_in(*newcomer_, expected, noise);
}

void Estimator::on_pose(const PoseSample& pose) {
  on_lidar_pose({pose.stamp, pose.T_world_body, Matrix6::Zero()});
}

bool Estimator::on_lidar_pose(const PoseMeasurement& pose) {
  if (!is_finite(pose.T_world_body) || !pose.covariance.allFinite()) {
    last_bad_input_ = pose.stamp;
    return false;
  }
  if (pose.stamp <= newest_pose_) return false;
  PoseMeasurement whole = pose;
  for (int i = 0; i < 3; ++i) {
    whole.covariance(i, i) += options_.pose_position_noise_m * options_.pose_position_noise_m;
    whole.covariance(i + 3, i + 3) += options_.pose_attitude_noise_rad * options_.pose_attitude_noise_rad;
  }
  const bool accepted = take_in(whole);
  choose();
  return accepted;
}

bool Estimator::take_in(const PoseMeasurement& pose) {
  using Verdict = InertialFilter::Verdict;
  const Verdict by_lidar = lidar_.on_pose(pose, options_.gate);
  const Verdict by_magnetic = magnetic_.on_pose(pose, options_.gate);
  const Verdict verdict = magnetic_believed_ ? by_magnetic : by_lidar;
  if (verdict == Verdict::ignored) return false;
  newest_pose_ = pose.stamp;
  if (verdict == Verdict::accepted) {
    last_pose_ = pose.stamp;
    if (guesses() && pose.stamp > guessed_until_) ++poses_since_guess_;
    refused_ = 0;
    newcomer_.reset();
  } else {
    doubt(pose);
  }
  magnetic_refused_ =
      by_lidar == Verdict::accepted && by_magnetic == Verdict::gated ? magnetic_refused_ + 1 : 0;
  if (magnetic_refused_ >= kMisled) {
    magnetic_ = lidar_;
    compass_.forget();
    magnetic_refused_ = 0;
  }
  return verdict == Verdict::accepted;
}

/// The believed filter refused a pose: either the pose or the filter is wrong.
void Estimator::doubt(const PoseMeasurement& pose) {
  if (++refused_ < kDoubt) return;
  if (newcomer_ && newcomer_->on_pose(pose, options_.gate) == InertialFilter::Verdict::accepted) {
    if (++agreed_ < kSettled) return;
    lidar_ = magnetic_ = *newcomer_;
    newcomer_.reset();
    refused_ = 0;
    last_pose_ = pose.stamp;
    ++restarts_;
    return;
  }
  newcomer_ = active();
  newcomer_->restart_at(pose);
  agreed_ = 0;
}

void Estimator::choose() {
  const double spread_rad = lidar_.heading_sigma_rad();
  const bool compass = compass_.trusted_s(state().stamp) >= kCompassTrusted_s;
  if (!magnetic_believed_ && spread_rad > kHeadingOpen_rad && compass) {
    magnetic_believed_ = true;
  } else if (magnetic_believed_ && (spread_rad < kHeadingKnown_rad || !compass)) {
    lidar_ = magnetic_;  // no jump: the LiDAR poses have corrected the magnetic filter as well
    magnetic_believed_ = false;
  }
}

void Estimator::on_magnetometer(const MagnetometerSample& mag) {
  if (!mag.field_ut.allFinite()) {
    last_bad_input_ = mag.stamp;
    return;
  }
  if (guesses() || !lidar_.started() || mag.stamp <= newest_mag_ || mag.stamp < state().stamp - kStale)
    return;
  newest_mag_ = mag.stamp;
  const Compass::Reading reading = compass_.read(mag, magnetic_.state().orientation);
  if (reading.valid)
    magnetic_.on_scalar({Scalar::Kind::heading_rad, reading.heading_rad, options_.compass_noise_rad});
  if (!magnetic_believed_ && lidar_.heading_sigma_rad() < kHeadingKnown_rad)
    compass_.learn(mag, lidar_.state().orientation);
}

void Estimator::on_barometer(const BarometerSample& barometer) {
  if (!std::isfinite(barometer.height_m)) {
    last_bad_input_ = barometer.stamp;
    return;
  }
  // The covariance of a guess is so wide that a sample's noise would become speed: 0.5 m of height, 1 m/s.
  if (guesses() || !lidar_.started() || barometer.stamp <= newest_height_ ||
      barometer.stamp < state().stamp - kStale)
    return;
  newest_height_ = barometer.stamp;
  if (active().height_sigma_m() < kHeightKnown_m) height_offset_.learn(barometer, state().position.z());
  if (!height_offset_.known()) return;
  const Scalar measured{Scalar::Kind::height_m, height_offset_.height_m(barometer), options_.height_noise_m};
  lidar_.on_scalar(measured);
  magnetic_.on_scalar(measured);
  if (newcomer_) newcomer_->on_scalar(measured);
}

Diagnosis Estimator::diagnose(TimeNs now) const {
  const TimeNs timeout = from_seconds(options_.pose_timeout_s);
  const TimeNs pose_silence = now - last_pose_, imu_silence = now - last_imu_;
  const double position_m = active().position_sigma_m(), heading_rad = active().heading_sigma_rad();
  if (pose_silence > 4 * timeout) return {Health::lost, "no pose for too long"};
  if (imu_silence > 4 * timeout) return {Health::lost, "no IMU for too long"};
  if (position_m > kPositionLost_m) return {Health::lost, "the position is not known any more"};
  if (pose_silence > timeout)
    return {Health::degraded, refused_ > 0 ? "poses contradict the IMU" : "no pose"};
  if (imu_silence > timeout) return {Health::degraded, "no IMU"};
  if (position_m > kPositionDegraded_m) return {Health::degraded, "the position is known badly"};
  if (heading_rad > kHeadingDegraded_rad) return {Health::degraded, "the heading is known badly"};
  if (last_bad_input_ > now - timeout) return {Health::degraded, "a measurement that is not a number"};
  return {};
}

}  // namespace karst::core
