#include "plugins/simulator/environment/clouds.h"

namespace karst::sim {

using core::Vec3;

namespace {

/// The part of a ray inside a cloud; empty if it leaves before it enters.
Passage pass(const cave::Cloud& cloud, const Vec3& from, const Vec3& direction) {
  Passage p{0, std::numeric_limits<double>::infinity(), cloud.extinction_1pm, 1 / cloud.lidar_ratio_sr};
  const Vec3 o = from - cloud.position;
  if (!cloud.box) {  // roots of |o + t d| = r
    const double b = o.dot(direction), r = cloud.half_size_m.x();
    const double disc = b * b - o.squaredNorm() + r * r;
    if (disc <= 0) return {};
    p.enter_m = std::max(-b - std::sqrt(disc), 0.0);
    p.leave_m = -b + std::sqrt(disc);
    return p;
  }
  for (int k = 0; k < 3; ++k) {  // slabs
    if (direction[k] == 0) {
      if (std::abs(o[k]) >= cloud.half_size_m[k]) return {};
      continue;
    }
    const double a = (-cloud.half_size_m[k] - o[k]) / direction[k],
                 b = (cloud.half_size_m[k] - o[k]) / direction[k];
    p.enter_m = std::max(p.enter_m, std::min(a, b));
    p.leave_m = std::min(p.leave_m, std::max(a, b));
  }
  return p;
}

}  // namespace

void CloudyPath::trace(std::span<const cave::Cloud> clouds, const cave::Ray& ray) {
  passages_.clear();
  for (const cave::Cloud& cloud : clouds) {
    const Passage p = pass(cloud, ray.origin.cast<double>(), ray.direction.cast<double>());
    if (p.leave_m <= p.enter_m) continue;
    first_m_ = clear() ? p.enter_m : std::min(first_m_, p.enter_m);
    last_m_ = clear() ? p.leave_m : std::max(last_m_, p.leave_m);
    passages_.push_back(p);
  }
}

double CloudyPath::depth(double range_m) const {
  double depth = 0;
  for (const Passage& p : passages_) depth += p.extinction_1pm * p.length_within_m(0, range_m);
  return depth;
}

CloudyPath::Stretch CloudyPath::stretch(double from_m, double to_m, double depth_before) const {
  Stretch s{to_m, from_m, 0, 0};
  double back = 0;  // backscatter weighted by depth
  for (const Passage& p : passages_) {
    const double length_m = p.length_within_m(from_m, to_m);
    if (length_m <= 0) continue;
    s.from_m = std::min(s.from_m, std::max(p.enter_m, from_m));
    s.to_m = std::max(s.to_m, std::min(p.leave_m, to_m));
    s.depth += p.extinction_1pm * length_m;
    back += p.extinction_1pm * length_m * p.backscatter_1psr;
  }
  if (s.depth > 0)
    s.mean_echo =
        std::numbers::pi / 2 * back / s.depth * std::exp(-2 * depth_before) * -std::expm1(-2 * s.depth);
  return s;
}

double CloudyPath::Stretch::place_m(core::Random& random) const {
  // Density proportional to exp(-2 tau) along the stretch.
  const double fraction = -std::log1p(random.uniform() * std::expm1(-2 * depth)) / (2 * depth);
  return from_m + fraction * (to_m - from_m);
}

}  // namespace karst::sim
