// Positions, poses and headings. World: x east, y north, z up. Body: x forward, y left, z up.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace karst::core {

using Vec3 = Eigen::Vector3d;
using Vec3f = Eigen::Vector3f;
using Quat = Eigen::Quaterniond;

/// A rigid transform; `T_a_b * p_b` is p in frame a. Products re-normalize the rotation: a chain of
/// thousands of products would otherwise drift off SO(3).
struct Pose {
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();

  Vec3 operator*(const Vec3& p) const { return position + orientation * p; }
  Pose operator*(const Pose& b) const {
    return {position + orientation * b.position, (orientation * b.orientation).normalized()};
  }
  Pose inverse() const {
    const Quat inv = orientation.conjugate();
    return {-(inv * position), inv};
  }
};

/// `v`, shortened to the length `most` if it is longer.
inline Vec3 at_most(const Vec3& v, double most) { return v.norm() > most ? Vec3(v * (most / v.norm())) : v; }

/// Angle in [-pi, pi).
inline double wrap_angle(double a) {
  constexpr double two_pi = 2.0 * std::numbers::pi;
  a = std::fmod(a + std::numbers::pi, two_pi);
  const double wrapped = (a < 0 ? a + two_pi : a) - std::numbers::pi;
  return wrapped < std::numbers::pi ? wrapped : -std::numbers::pi;  // a turn more may round to pi itself
}

/// Heading in radians, counter-clockwise from east: where the body's x axis points, seen from above.
inline double heading_of(const Quat& q) {
  const Vec3 forward = q * Vec3::UnitX();
  return std::atan2(forward.y(), forward.x());
}

inline Quat from_heading(double heading_rad) { return Quat(Eigen::AngleAxisd(heading_rad, Vec3::UnitZ())); }

}  // namespace karst::core
