// A rotation as roll, pitch and yaw: about the fixed axes x, y, z in this order, in radians.
#pragma once
#include <algorithm>
#include <cmath>

#include "core_stack/common/geometry.h"

namespace karst::core {

inline Quat rotation_of_euler(const Vec3& roll_pitch_yaw) {
  return Quat(Eigen::AngleAxisd(roll_pitch_yaw.z(), Vec3::UnitZ()) *
              Eigen::AngleAxisd(roll_pitch_yaw.y(), Vec3::UnitY()) *
              Eigen::AngleAxisd(roll_pitch_yaw.x(), Vec3::UnitX()))
      .normalized();
}

/// With x upright, roll and yaw turn about one axis: all of it is yaw's then.
inline Vec3 euler_angles_of(const Quat& q) {
  const Eigen::Matrix3d R = q.toRotationMatrix();
  const double pitch = std::asin(std::clamp(-R(2, 0), -1.0, 1.0));
  if (std::abs(R(2, 0)) > 1 - 1e-12) return {0, pitch, std::atan2(-R(0, 1), R(1, 1))};
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

}  // namespace karst::core
