// Motion of the vehicle during a sweep, to transform all points to the body frame at the sweep's end.
#pragma once
#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

#include "core_stack/localization/state.h"
#include "core_stack/localization/sweep.h"

namespace karst::core {

/// Constant velocity (body frame) and constant body rate.
struct Twist {
  Vec3 velocity_mps = Vec3::Zero();
  Vec3 rate_radps = Vec3::Zero();
};

/// The twist, in the body frame, of a motion between two poses that took `dt_s` > 0.
Twist twist_between(const Pose& T_world_from, const Pose& T_world_to, double dt_s);
/// T_now_then: pose of the body `dt_s` after now (before now if negative), in the body frame now.
Pose pose_after(const Twist& twist, double dt_s);

/// The pose at `t`, interpolated between states or extrapolated by at most 30 ms.
std::optional<Pose> predicted_pose(const StateHistory& states, TimeNs t);

/// T_end_lidar at any time of the sweep, from a table fine enough for nearest-entry look-up.
class SweepMotion {
 public:
  /// Evaluates `T_end_body(time_s)` at times from -length_s to 0.
  SweepMotion(double length_s, const Pose& T_body_lidar, const std::function<Pose(double)>& T_end_body);

  /// Transforms a point from the lidar frame at `time_s` to the body frame at the sweep's end.
  Vec3f to_body_at_end(const Vec3f& p, float time_s) const {
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): never negative, and lround() is slower
    const auto i = static_cast<std::size_t>(std::max(-time_s, 0.0f) * steps_per_s_ + 0.5f);
    const Step& s = steps_[std::min(i, steps_.size() - 1)];
    return s.rotation * p + s.translation;
  }

 private:
  struct Step {
    Eigen::Matrix3f rotation;
    Vec3f translation;
  };
  std::vector<Step> steps_;  // backwards in time from the sweep's end
  float steps_per_s_ = 0;
};

}  // namespace karst::core
