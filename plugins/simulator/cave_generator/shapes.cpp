#include "plugins/simulator/cave_generator/shapes.h"

#include <algorithm>
#include <cmath>

namespace karst::cave {
namespace {

using core::Vec3;

/// First-order distance to an ellipsoid with its axes along the coordinates: exact on the surface.
double ellipsoid_distance(const Vec3& p, const Vec3& radii) {
  const double k0 = p.cwiseQuotient(radii).norm();
  const double k1 = p.cwiseQuotient(radii.cwiseProduct(radii)).norm();
  return k1 > 0 ? k0 * (k0 - 1) / k1 : -radii.minCoeff();
}

double smooth_max(double a, double b, double k) { return -smooth_min(-a, -b, k); }

/// Parameter in 0..1 of the point of segment a-b nearest to p.
double along(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length_squared = ab.squaredNorm();
  return length_squared > 0 ? std::clamp((p - a).dot(ab) / length_squared, 0.0, 1.0) : 0;
}

}  // namespace

double smooth_min(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0);
  return std::min(a, b) - h * h / (4 * k);
}

Segment::Segment(const Station& a, const Station& b) : from(a), to(b) {
  const Vec3 ab = b.center - a.center;
  length_m = ab.norm();
  axis = length_m > 0 ? Vec3(ab / length_m) : Vec3::UnitX();
  const Vec3 level = axis.cross(Vec3::UnitZ());
  flatness = level.norm();
  side = flatness > 1e-3 ? Vec3(level / flatness) : Vec3::UnitX();
  up = side.cross(axis);
  const auto reach = [](const Station& s) {
    return std::max(s.half_width_m, s.half_height_m * (1 + s.slot));
  };
  reach_m = std::max(reach(a), reach(b));
}

Foot foot_of(const Vec3& p, const Segment& s) {
  const Vec3 w = p - s.from.center;
  const double along_m = std::clamp(w.dot(s.axis), 0.0, s.length_m);
  return {s.length_m > 0 ? along_m / s.length_m : 0, w - along_m * s.axis};
}

double segment_distance(const Foot& foot, const Segment& s) {
  const auto mix = [t = foot.along](double a, double b) { return a + t * (b - a); };
  const double a = mix(s.from.half_width_m, s.to.half_width_m),
               b = mix(s.from.half_height_m, s.to.half_height_m);
  const Vec3 local(foot.offset.dot(s.side), foot.offset.dot(s.up), foot.offset.dot(s.axis));
  double d = ellipsoid_distance(local, {a, b, std::min(a, b)});
  // A steep passage has no floor, and water fell through it instead of cutting a slot.
  const double level = std::clamp((s.flatness - 0.6) * 5, 0.0, 1.0);
  const double slot = mix(s.from.slot, s.to.slot) * level;
  if (slot > 0.05) {
    const Vec3 radii(std::max(0.8, 0.35 * a), b * (0.3 + slot), std::min(a, b));
    d = smooth_min(d, ellipsoid_distance(local + Vec3(0, b * 0.7, 0), radii), 0.5);
  }
  if (level == 0) return d;
  const double floor = mix(s.from.floor_m, s.to.floor_m) + (slot + 1 - level) * b;
  return smooth_max(d, -local.y() - floor, 0.5);
}

double chamber_distance(const Vec3& p, const Chamber& c) {
  const Vec3 w = p - c.center;
  const double cosine = std::cos(c.heading_rad), sine = std::sin(c.heading_rad);
  const Vec3 local(cosine * w.x() + sine * w.y(), -sine * w.x() + cosine * w.y(), w.z());
  return smooth_max(ellipsoid_distance(local, c.radii), c.floor_z - p.z(), 0.6);
}

double boulder_distance(const Vec3& p, const Boulder& b) {
  const double round = 0.25 * b.half.minCoeff();
  const Vec3 q = (b.orientation.conjugate() * (p - b.center)).cwiseAbs() - b.half + Vec3::Constant(round);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - round;
}

double speleothem_distance(const Vec3& p, const Speleothem& s) {
  const double t = along(p, s.base, s.tip);
  const double radius = s.base_radius_m + t * (s.tip_radius_m - s.base_radius_m);
  return (p - s.base - t * (s.tip - s.base)).norm() - radius;
}

}  // namespace karst::cave
