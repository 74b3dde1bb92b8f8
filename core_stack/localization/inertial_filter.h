// One hypothesis about the vehicle's state: an error-state Kalman filter on the IMU (Sola, arXiv:1711.02508),
// corrected by delayed poses.
//
// The nominal state is propagated with every IMU sample (strap-down, trapezoidal rule). The error state is
// (position, velocity: world; attitude: rotation vector in the body; accelerometer and gyroscope bias). A
// pose is applied at its stamp, in a buffer of the past second; the samples, headings and heights that
// arrived after that stamp are then replayed.
#pragma once
#include <boost/circular_buffer.hpp>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core_stack/common/options.h"
#include "core_stack/localization/state.h"
#include "core_stack/vehicle/messages.h"

namespace karst::core {

using Vector15 = Eigen::Matrix<double, 15, 1>;
using Matrix15 = Eigen::Matrix<double, 15, 15>;

struct InertialNoise {
  // Standard deviations. The IMU noise is that of one sample at 200 Hz; the accelerometer noise includes the
  // effects of a small tilt error and of the vehicle's vibration.
  double accel_noise_mps2 = 0.15;
  double gyro_noise_radps = 0.008;
  double accel_bias_drift_mps2 = 0.01;  // random walk of the bias in one second
  double gyro_bias_drift_radps = 0.0005;
};

/// A measured pose with the covariance of (translation in the world, rotation in the body).
struct PoseMeasurement {
  TimeNs stamp = 0;
  Pose T_world_body;
  Matrix6 covariance = Matrix6::Identity();
};

class InertialFilter {
 public:
  InertialFilter(const InertialNoise& noise, const Pose& T_world_start);

  /// Ignores samples not newer than the last one. `noise_scale` is above 1 for predicted samples: a measured
  /// one that comes late takes the place of those predicted for its time and later.
  void on_imu(const ImuSample& imu, double noise_scale = 1);

  enum class Verdict { accepted, gated, ignored };
  /// Gated: the pose is `gate` standard deviations or more from the prediction. Ignored: it is not newer than
  /// the last accepted pose, or not within the buffer.
  Verdict on_pose(const PoseMeasurement& pose, double gate);
  /// A measurement of the current heading, or of the height above the world's origin, with deviation `sigma`.
  struct Scalar {
    enum class Kind { heading_rad, height_m } kind;
    double value, sigma;
  };
  void on_scalar(const Scalar& measured);

  /// What the vehicle did up to the last sample was not measured: it may hover metres from there, level. The
  /// velocity is not told by how far the next pose is from here.
  void lose_track();

  /// Restarts at a pose within the buffer, with the velocity and biases known at that time.
  void restart_at(const PoseMeasurement& pose);

  bool started() const { return !steps_.empty(); }
  const State& state() const { return state_; }  // at the last IMU sample
  /// The corrected states of the last 2 s, one for every IMU sample.
  const StateHistory& history() const { return history_; }
  const Matrix15& covariance() const { return covariance_; }
  /// Greatest standard deviation of the position over all directions, and that of the heading.
  double position_sigma_m() const;
  double heading_sigma_rad() const;
  double height_sigma_m() const { return std::sqrt(covariance_(2, 2)); }
  Vec3 accel_bias_mps2() const { return accel_bias_mps2_; }
  Vec3 gyro_bias_radps() const { return gyro_bias_radps_; }

 private:
  struct Step {
    ImuSample imu;  // the sample that led to the state below
    double noise_scale;
    State state;
    Vec3 accel_bias_mps2, gyro_bias_radps;
    Matrix15 covariance;
    boost::container::small_vector<Scalar, 4> scalars;  // scalars applied after this step
  };
  void propagate(const ImuSample& before, const ImuSample& after, double noise_scale);
  void correct(const Scalar& measured);
  void inject(const Vector15& error);
  void drop_predicted(TimeNs since);
  std::optional<std::size_t> step_at(TimeNs stamp) const;
  void go_back_to(std::size_t step);
  void replay_after(std::size_t step);
  void note(const ImuSample& imu, double noise_scale);

  InertialNoise noise_;
  State state_;
  Vec3 accel_bias_mps2_ = Vec3::Zero(), gyro_bias_radps_ = Vec3::Zero();  // body frame
  Matrix15 covariance_;
  // The buffers allocate memory only if samples arrive faster than ever before.
  static constexpr std::size_t kUsual = 256;  // 1 s at 200 Hz, with a margin
  boost::circular_buffer<Step> steps_{kUsual};
  std::vector<Step> later_;  // the later steps, during a replay
  StateHistory history_;
  TimeNs last_pose_ = std::numeric_limits<TimeNs>::min();
};

}  // namespace karst::core
