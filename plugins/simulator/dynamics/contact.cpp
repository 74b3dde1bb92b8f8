#include "plugins/simulator/dynamics/contact.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace karst::sim {

using core::Vec3;

namespace {

constexpr double kLook_m = 50;
constexpr double kSteepest_rad = 50 * std::numbers::pi / 180;
constexpr double kHardest_mps = 0.8;

}  // namespace

cave::Nearest ContactWatch::query(const Vec3& position) {
  const cave::Nearest n = scene_->nearest(position, kLook_m);
  last_position_ = position;
  last_distance_m_ = n.distance_m;
  ++queries_;
  return n;
}

std::optional<Touch> ContactWatch::touch(const Vec3& position) {
  const double min_m = last_distance_m_ - (position - last_position_).norm();
  if (last_distance_m_ >= 0 && min_m > radius_m_) return std::nullopt;
  const cave::Nearest n = query(position);
  if (n.distance_m > radius_m_ || !n.found) return std::nullopt;
  const Vec3 offset = n.point - position;
  const Vec3 direction = n.distance_m > 1e-6 ? Vec3(offset / n.distance_m) : Vec3(-Vec3::UnitZ());
  return Touch{n.point, direction, radius_m_ - n.distance_m};
}

double ContactWatch::clearance_m(const Vec3& position) { return query(position).distance_m - radius_m_; }

double angle_from_down_rad(const Touch& touch) {
  return std::acos(std::clamp(-touch.direction.z(), -1.0, 1.0));
}

bool supports(const Touch& touch, const Vec3& velocity_mps) {
  return angle_from_down_rad(touch) <= kSteepest_rad && velocity_mps.norm() < kHardest_mps;
}

}  // namespace karst::sim
