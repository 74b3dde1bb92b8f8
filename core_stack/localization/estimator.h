// State estimation: a small bank of filters on the IMU, corrected by poses from the LiDAR, which arrive late.
//
//   lidar      IMU and poses. The one to believe, as a rule: ore does not bend it.
//   magnetic   the same and the compass. Believed while the poses leave the heading open, as in a round
//   shaft, and
//              the compass is not disturbed.
//   newcomer   begun at a pose that the others refuse. If further poses agree with it for a second while the
//              others still refuse them, the bank starts over from it.
//
// The barometer holds the height of all where the LiDAR leaves it open, as in a smooth shaft.
//
// A pose that is far from what a filter expects does not enter it; until one is accepted again, the IMU alone
// carries it, and its covariance grows. Health is judged by that. Switching has hysteresis.
#pragma once
#include <limits>
#include <optional>

#include "core_stack/localization/compass.h"
#include "core_stack/localization/height_offset.h"
#include "core_stack/localization/hypothesis.h"
#include "core_stack/localization/inertial_filter.h"

namespace karst::core {

struct EstimatorOptions {
  InertialNoise imu;
  double pose_position_noise_m = 0.01;  // of the pose sensor; of LiDAR poses, what comes on top of theirs
  double pose_attitude_noise_rad = 0.0035;
  double compass_noise_rad = 0.2;  // of one sample; their errors last
  double height_noise_m = 0.6;     // of one barometer sample, likewise
  double gate = 6;                 // poses off by so many standard deviations are refused
  double pose_timeout_s = 0.5;     // health degrades without a pose for so long; lost at four times that
};
void describe(OptionTable& t, EstimatorOptions& o);

struct Diagnosis {
  Health health = Health::good;
  const char* reason = "";
};

class Estimator {
 public:
  Estimator(const EstimatorOptions& options, const Pose& T_world_start);
  /// Samples that are not finite or not newer than the last are ignored.
  void on_imu(const ImuSample& imu);
  /// What the IMU would have measured, where it is silent: by the last command and the mass.
  void bridge(const ImuSample& expected);
  /// Poses that are not finite, not newer than the last, or older than a second are ignored.
  void on_pose(const PoseSample& pose);
  /// The same of a LiDAR pose, with its covariance. True if it was accepted.
  bool on_lidar_pose(const PoseMeasurement& pose);
  void on_magnetometer(const MagnetometerSample& mag);
  void on_barometer(const BarometerSample& barometer);

  const State& state() const { return active().state(); }  // at the last IMU sample
  /// The states as corrected: 2 s, every IMU sample.
  const StateHistory& history() const { return active().history(); }
  /// Degraded: no pose accepted or no IMU sample for the timeout, an input within it that was not finite, or
  /// a position or heading known too badly to fly fast.
  Diagnosis diagnose(TimeNs now) const;
  Health health(TimeNs now) const { return diagnose(now).health; }
  Hypothesis believed() const { return magnetic_believed_ ? Hypothesis::magnetic : Hypothesis::lidar; }
  int restarts() const { return restarts_; }
  TimeNs last_imu() const { return last_imu_; }
  const InertialFilter& active() const { return magnetic_believed_ ? magnetic_ : lidar_; }

 private:
  bool take_in(const PoseMeasurement& pose);
  void doubt(const PoseMeasurement& pose);
  void choose();

  EstimatorOptions options_;
  InertialFilter lidar_, magnetic_;
  std::optional<InertialFilter> newcomer_;
  Compass compass_;
  HeightOffset height_offset_;
  bool magnetic_believed_ = false;
  int refused_ = 0, agreed_ = 0, magnetic_refused_ = 0, restarts_ = 0;
  TimeNs last_imu_ = 0, last_pose_ = 0;
  TimeNs newest_pose_ = std::numeric_limits<TimeNs>::min();  // accepted or not
  TimeNs newest_mag_ = std::numeric_limits<TimeNs>::min(), newest_height_ = newest_mag_;
  TimeNs last_bad_input_ = std::numeric_limits<TimeNs>::min();
};

}  // namespace karst::core
