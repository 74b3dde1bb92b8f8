#include "sdk/replay/imu_prediction.h"

#include <algorithm>

namespace karst::replay {

using core::TimeNs;
using core::Vec3;

ImuPrediction::ImuPrediction(SensorStream& sensors, const core::EstimatorOptions& options, TimeNs origin,
                             bool level, double still_s)
    : sensors_(sensors), origin_(origin) {
  // An IMU often runs before the first scan: samples older than `still_s` before it are not used.
  const TimeNs still = core::from_seconds(still_s);
  Vec3 force = Vec3::Zero();
  for (TimeNs begin = 0; auto sample = sensors_.next_imu();) {
    sample->stamp -= origin_;
    if (sample->stamp < -still) continue;
    if (waiting_.empty()) begin = sample->stamp;
    force += sample->specific_force_mps2;
    waiting_.push_back(*sample);
    if (sample->stamp > begin + still) break;
  }
  std::reverse(waiting_.begin(), waiting_.end());
  if (level && force.norm() > 0)
    T_world_start_.orientation = core::Quat::FromTwoVectors(force, Vec3::UnitZ()).normalized();
  // Rotating a strongly tilted body upright about a level axis changes its heading, so this sets it to 0.
  T_world_start_.orientation =
      (core::from_heading(-core::heading_of(T_world_start_.orientation)) * T_world_start_.orientation)
          .normalized();
  estimator_.emplace(options, T_world_start_);
}

std::optional<core::ImuSample> ImuPrediction::take() {
  if (!waiting_.empty()) {
    const core::ImuSample s = waiting_.back();
    waiting_.pop_back();
    return s;
  }
  auto sample = sensors_.next_imu();
  if (sample) sample->stamp -= origin_;
  return sample;
}

const core::StateHistory& ImuPrediction::up_to(TimeNs stamp) {
  while (const auto sample = take()) {
    if (sample->stamp > stamp) {
      waiting_.push_back(*sample);
      break;
    }
    if (sample->stamp <= 0) continue;  // the estimator's time begins at 0
    estimator_->on_imu(*sample);
    ++samples_;
  }
  return estimator_->history();
}

void ImuPrediction::correct(const core::LoamPose& pose) {
  if (pose.valid) estimator_->on_lidar_pose({pose.stamp, pose.T_world_body, pose.covariance});
}

}  // namespace karst::replay
