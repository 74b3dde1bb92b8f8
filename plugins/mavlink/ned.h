// Frames. karst: world x east, y north, z up (ENU), body x forward, y left, z up (FLU). Autopilots: world x
// north, y east, z down (NED), body x forward, y right, z down (FRD). Each change of frame is its own
// inverse.
#pragma once
#include "core_stack/common/geometry.h"

namespace karst::mavlink {

inline core::Vec3 ned_of_enu(const core::Vec3& v) { return {v.y(), v.x(), -v.z()}; }
inline core::Vec3 enu_of_ned(const core::Vec3& v) { return ned_of_enu(v); }
inline core::Vec3 frd_of_flu(const core::Vec3& v) { return {v.x(), -v.y(), -v.z()}; }
inline core::Vec3 flu_of_frd(const core::Vec3& v) { return frd_of_flu(v); }

/// R_ned_frd = R_ned_enu R_enu_flu R_flu_frd. Half turns: about (1, 1, 0) in the world, about x in the body.
inline core::Quat ned_frd_of_enu_flu(const core::Quat& q) {
  constexpr double h = std::numbers::sqrt2 / 2;
  const core::Quat ned_enu(0, h, h, 0), flu_frd(0, 1, 0, 0);
  core::Quat out = ned_enu * q * flu_frd;
  if (out.w() < 0) out.coeffs() *= -1;
  return out;
}
inline core::Quat enu_flu_of_ned_frd(const core::Quat& q) { return ned_frd_of_enu_flu(q); }

/// Heading from east, counter-clockwise, to yaw from north, clockwise; and back.
inline double yaw_of_heading(double heading_rad) {
  return core::wrap_angle(std::numbers::pi / 2 - heading_rad);
}
inline double heading_of_yaw(double yaw_rad) { return yaw_of_heading(yaw_rad); }

}  // namespace karst::mavlink
