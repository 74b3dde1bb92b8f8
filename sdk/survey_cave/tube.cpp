#include "sdk/survey_cave/tube.h"

#include <algorithm>
#include <cmath>

namespace karst::survey_cave {

using core::Vec3;

namespace {

constexpr double kRound = 0.3;  // radius of a cap's edge over the lesser of width and height

Vec3 up_of(const TubeEnd& end) { return end.normal.cross(end.left); }

Vec3 corner_of(const TubeEnd& end, std::size_t k) {
  const Vec2& c = end.outline.corners[k];
  return c.x() * end.left + c.y() * up_of(end);
}

}  // namespace

Tube::Tube(const TubeEnd& from, const TubeEnd& to, std::uint32_t leg, std::uint32_t passage)
    : from_(from),
      to_(to),
      axis_((to.centre - from.centre).normalized()),
      length_m_((to.centre - from.centre).norm()),
      reach_m_(0),
      from_gradient_(from.normal / from.normal.dot(axis_)),
      to_gradient_(to.normal / to.normal.dot(axis_)),
      leg_(leg),
      passage_(passage) {
  double change_m = 0;  // greatest way of a corner from one end to the other, relative to the centre line
  for (std::size_t k = 0; k < kCorners; ++k) {
    for (const TubeEnd* end : {&from_, &to_})
      reach_m_ = std::max(reach_m_, std::hypot(end->outline.corners[k].norm(), end->open ? 0.0 : end->cap_m));
    change_m = std::max(change_m, (corner_of(from_, k) - corner_of(to_, k)).norm());
  }
  constexpr double kLeastGap = 0.3;  // of two planes within the tube, see is_mitred() in passages.cpp
  slope_ = 1 + change_m / (kLeastGap * length_m_);
}

Tube::Frame Tube::frame_at(double t) const {
  const Vec3 normal = (from_gradient_ + t * (to_gradient_ - from_gradient_)).normalized();
  Vec3 left = from_.left + t * (to_.left - from_.left);
  left = (left - left.dot(normal) * normal).normalized();
  return {normal, left, normal.cross(left)};
}

double Tube::far_distance(const Vec3& p) const {
  const Vec3 w = p - from_.centre;
  return (w - std::clamp(w.dot(axis_), 0.0, length_m_) * axis_).norm() - reach_m_;
}

double Tube::at_end(const Vec3& p, bool second) const {
  const TubeEnd& end = second ? to_ : from_;
  const Vec3 w = p - end.centre;
  const double beyond = (second ? 1 : -1) * w.dot(end.normal);
  const double d = distance_to(end.outline, end.outline, 0, {w.dot(end.left), w.dot(up_of(end))});
  if (end.open) return d > 0 ? std::hypot(d, beyond) : beyond;
  // The outline extruded, its edge rounded.
  const double round_m = std::min(end.cap_m, kRound * size_of(end.outline).minCoeff());
  const double x = d + round_m, z = beyond - (end.cap_m - round_m);
  return std::min(std::max(x, z), 0.0) + std::hypot(std::max(x, 0.0), std::max(z, 0.0)) - round_m;
}

double Tube::distance(const Vec3& p) const {
  const double a = (p - from_.centre).dot(from_gradient_), b = (to_.centre - p).dot(to_gradient_);
  if (a < 0 && b < 0) return std::max(far_distance(p), 0.01);  // beyond the line where the planes meet
  if (a < 0) return std::max(at_end(p, false), far_distance(p));
  if (b < 0) return std::max(at_end(p, true), far_distance(p));
  const double t = a + b > 0 ? a / (a + b) : 0.5;
  const Frame f = frame_at(t);
  const Vec3 w = p - from_.centre - t * length_m_ * axis_;
  const double d = distance_to(from_.outline, to_.outline, t, {w.dot(f.left), w.dot(f.up)});
  return std::max(d * f.normal.dot(axis_), far_distance(p));
}

double Tube::least_distance(const Vec3& p, double enough_m) const {
  const double far = far_distance(p);
  if (far > enough_m) return far;
  const double d = distance(p);
  return d > 0 ? std::max(d / slope_, far) : d;
}

bool Tube::holds_ball(const Vec3& p, double radius_m) const {
  constexpr double kMild = 3;
  if (slope_ > kMild) return false;
  const double a = (p - from_.centre).dot(from_.normal), b = (to_.centre - p).dot(to_.normal);
  return a > radius_m && b > radius_m && distance(p) < -slope_ * radius_m;
}

Vec2 Tube::size_at(double t) const {
  Outline outline;
  for (std::size_t k = 0; k < kCorners; ++k)
    outline.corners[k] = from_.outline.corners[k] + t * (to_.outline.corners[k] - from_.outline.corners[k]);
  const Frame f = frame_at(t);
  const auto across = [&](const Vec3& v) { return (v - v.dot(axis_) * axis_).norm(); };
  return size_of(outline).cwiseProduct(Vec2(across(f.left), across(f.up)));
}

Vec3 Tube::middle_at(double t) const {
  const Vec2 a = middle_of(from_.outline), b = middle_of(to_.outline), m = a + t * (b - a);
  const Frame f = frame_at(t);
  return from_.centre + t * length_m_ * axis_ + m.x() * f.left + m.y() * f.up;
}

}  // namespace karst::survey_cave
