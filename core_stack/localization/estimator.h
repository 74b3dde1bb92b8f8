// State estimation: a small bank of filters on the IMU, corrected by poses from the LiDAR, which arrive late.
//
//   lidar      IMU and LiDAR poses. Normally believed, because ore does not disturb it.
//   magnetic   the same with the compass. Believed while the poses do not determine the heading, as in a
//              round shaft,
//              and the compass is not disturbed.
//   newcomer   started at a pose that the others refuse. If it accepts further poses for a second while the
//              others still refuse them, all filters restart from it.
//
// The barometer corrects the height of all filters where the LiDAR does not observe it, as in a smooth shaft.
//
// A pose that is far from a filter's prediction is refused; until the filter accepts one again, it integrates
// the IMU alone and its covariance grows. Health is judged by that covariance. Switching has hysteresis.
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
  double pose_position_noise_m = 0.01;  // of the pose sensor; added to the covariance of LiDAR poses
  double pose_attitude_noise_rad = 0.0035;
  double compass_noise_rad = 0.2;  // of one sample; the errors are correlated in time
  double height_noise_m = 0.6;     // of one barometer sample; also correlated in time
  double gate = 6;                 // poses off by this many standard deviations or more are refused
  double pose_timeout_s = 0.5;     // health degrades after this time without a pose; lost: four times that
};
void describe(OptionTable& t, EstimatorOptions& o);

struct Diagnosis {
  Health health = Health::good;
  const char* reason = "";
};

class Estimator {
 public:
  Estimator(const EstimatorOptions& options, const Pose& T_world_start);
  /// Ignores samples that are not finite, not newer than the last one measured, or older than a second where
  /// predicted ones are newer.
  void on_imu(const ImuSample& imu);
  /// While the IMU delivers no data: takes the measurement expected from the last command and the mass, or of
  /// a hover if another steers, who may do anything.
  enum class Expected { as_commanded, another_steers };
  void bridge(const ImuSample& expected, Expected how = Expected::as_commanded);
  /// Nobody measured for a while what the vehicle did.
  void lose_track();
  /// Stamp of the newest sample at the last time. A sweep that began before is bent by what nobody measured.
  TimeNs track_lost_at() const { return track_lost_at_; }
  /// Another steered while the IMU was silent, or nobody measured, and no two poses since then have told
  /// where it is and how fast.
  bool guesses() const { return poses_since_guess_ < kPosesThatTell; }
  /// Ignores poses that are not finite, not newer than the last one, or older than a second.
  void on_pose(const PoseSample& pose);
  /// The same for a LiDAR pose with its covariance. Returns true if the pose was accepted.
  bool on_lidar_pose(const PoseMeasurement& pose);
  void on_magnetometer(const MagnetometerSample& mag);
  void on_barometer(const BarometerSample& barometer);

  const State& state() const { return active().state(); }  // at the last IMU sample
  /// The corrected states of the last 2 s, one for every IMU sample.
  const StateHistory& history() const { return active().history(); }
  /// Degraded: within the timeout no pose was accepted, no IMU sample arrived or an input was not finite; or
  /// the position or heading is too uncertain to fly fast.
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
  TimeNs track_lost_at_ = std::numeric_limits<TimeNs>::min();
  TimeNs guessed_until_ = std::numeric_limits<TimeNs>::min();  // the newest sample bridged for another
  static constexpr int kPosesThatTell = 2;
  int poses_since_guess_ = kPosesThatTell;  // accepted; or more
  int before_guess_ = kPosesThatTell;       // the same when the guess began
  TimeNs last_bad_input_ = std::numeric_limits<TimeNs>::min();
};

}  // namespace karst::core
