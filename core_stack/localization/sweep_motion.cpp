#include "core_stack/localization/sweep_motion.h"

#include "core_stack/common/so3.h"

namespace karst::core {

namespace {
constexpr TimeNs kMaxExtrapolation = 30 * kMillisecond;
constexpr int kSteps = 512;  // steps per sweep: 1 mm at 5 m/s and 10 Hz, 0.4 mrad at 2 rad/s
constexpr int kKnots = 32;   // number of poses requested; the steps between them are interpolated
}  // namespace

Twist twist_between(const Pose& T_world_from, const Pose& T_world_to, double dt_s) {
  const Pose T_to_from = T_world_to.inverse() * T_world_from;
  return {-T_to_from.position / dt_s, -log_so3(T_to_from.orientation) / dt_s};
}

Pose pose_after(const Twist& twist, double dt_s) {
  return {twist.velocity_mps * dt_s, exp_so3(twist.rate_radps * dt_s)};
}

std::optional<Pose> predicted_pose(const StateHistory& states, TimeNs t) {
  if (states.states().empty()) return {};
  const State& oldest = states.states().front();
  const State& newest = states.states().back();
  if (t < oldest.stamp - kMaxExtrapolation || t > newest.stamp + kMaxExtrapolation) return {};
  if (t >= oldest.stamp && t <= newest.stamp) return states.pose_at(t);
  const State& end = t < oldest.stamp ? oldest : newest;
  const double dt_s = seconds(t - end.stamp);
  return Pose{end.position + end.velocity_mps * dt_s,
              (end.orientation * exp_so3(end.body_rate_radps * dt_s)).normalized()};
}

SweepMotion::SweepMotion(double length_s, const Pose& T_body_lidar,
                         const std::function<Pose(double)>& T_end_body) {
  if (length_s <= 0) {
    const Pose T = T_end_body(0) * T_body_lidar;
    steps_ = {{T.orientation.toRotationMatrix().cast<float>(), T.position.cast<float>()}};
    return;
  }
  steps_per_s_ = static_cast<float>(kSteps / length_s);
  constexpr int kEach = kSteps / kKnots;
  Pose near = T_end_body(0) * T_body_lidar;
  for (int knot = 0; knot < kKnots; ++knot) {
    const Pose far = T_end_body(-length_s * (knot + 1) / kKnots) * T_body_lidar;
    for (int i = 0; i < kEach; ++i) {
      const double fraction = static_cast<double>(i) / kEach;
      const Quat q = near.orientation.slerp(fraction, far.orientation);
      const Vec3 p = near.position + fraction * (far.position - near.position);
      steps_.push_back({q.toRotationMatrix().cast<float>(), p.cast<float>()});
    }
    near = far;
  }
  steps_.push_back({near.orientation.toRotationMatrix().cast<float>(), near.position.cast<float>()});
}

}  // namespace karst::core
