// Rotation vectors: the exponential map from so(3) to rotations, and its inverse.
#pragma once
#include "core_stack/common/geometry.h"

namespace karst::core {

/// Rotation by |v| radians about v.
inline Quat exp_so3(const Vec3& v) {
  const double angle = v.norm();
  if (angle < 1e-9) return Quat(1, v.x() / 2, v.y() / 2, v.z() / 2).normalized();
  return Quat(Eigen::AngleAxisd(angle, v / angle));
}

/// The rotation vector of `q`, of length 0 to pi.
inline Vec3 log_so3(const Quat& q) {
  const Vec3 v = q.w() < 0 ? Vec3(-q.vec()) : Vec3(q.vec());
  const double sine = v.norm(), cosine = std::abs(q.w());
  return sine < 1e-9 ? Vec3(2 * v) : Vec3(2 * std::atan2(sine, cosine) / sine * v);
}

inline Eigen::Matrix3d skew(const Vec3& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace karst::core
