#include "sdk/survey_cave/outline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace karst::survey_cave {
namespace {

constexpr double kPi = std::numbers::pi, kTurn = 2 * kPi;
constexpr double kLeast_m = 0.01;  // a wall through the station itself

struct Ray {
  double angle_rad, distance_m;
};

double between(double a_rad, double b_rad) { return std::abs(core::wrap_angle(a_rad - b_rad)); }

/// Sorted by angle from -pi, those close together joined.
std::vector<Ray> joined_rays(const std::vector<Vec2>& points) {
  constexpr double kTogether_rad = 5 * kPi / 180;
  std::vector<Ray> rays, joined;
  for (const Vec2& p : points) rays.push_back({std::atan2(p.y(), p.x()), p.norm()});
  std::stable_sort(rays.begin(), rays.end(), [](const Ray& a, const Ray& b) {
    return a.angle_rad != b.angle_rad ? a.angle_rad < b.angle_rad : a.distance_m < b.distance_m;
  });
  for (std::size_t i = 0; i < rays.size();) {
    Ray mean{0, 0};
    std::size_t n = 0;
    for (; i + n < rays.size() && rays[i + n].angle_rad - rays[i].angle_rad <= kTogether_rad; ++n) {
      mean.angle_rad += rays[i + n].angle_rad;
      mean.distance_m += rays[i + n].distance_m;
    }
    joined.push_back({mean.angle_rad / static_cast<double>(n), mean.distance_m / static_cast<double>(n)});
    i += n;
  }
  return joined;
}

double distance_at(const std::vector<Ray>& rays, double angle_rad) {
  const auto after = std::upper_bound(rays.begin(), rays.end(), angle_rad,
                                      [](double a, const Ray& r) { return a < r.angle_rad; });
  const Ray& next = after == rays.end() ? rays.front() : *after;
  const Ray& last = after == rays.begin() ? rays.back() : *(after - 1);
  double gap = next.angle_rad - last.angle_rad, along = angle_rad - last.angle_rad;
  if (gap <= 0) gap += kTurn;
  if (along < 0) along += kTurn;
  return last.distance_m + along / gap * (next.distance_m - last.distance_m);
}

}  // namespace

Outline superellipse(const Extents& e) {
  Outline out;
  const auto side = [](double c, double plus, double minus) {
    if (std::abs(c) < 1e-12) return 0.0;
    return std::copysign(std::pow(std::abs(c), 2 / kExponent), c) * std::max(c > 0 ? plus : minus, kLeast_m);
  };
  for (std::size_t k = 0; k < kCorners; ++k) {
    const double a = kTurn * static_cast<double>(k) / kCorners;
    out.corners[k] = {side(std::cos(a), e.left_m, e.right_m), side(std::sin(a), e.up_m, e.down_m)};
  }
  return out;
}

Outline through_points(const std::vector<Vec2>& points, const Extents& extents) {
  constexpr double kSeen_rad = kPi / 6;
  std::vector<Ray> rays = joined_rays(points);
  const std::array<Ray, 4> walls{
      {{0, extents.left_m}, {kPi / 2, extents.up_m}, {-kPi, extents.right_m}, {-kPi / 2, extents.down_m}}};
  const std::size_t measured = rays.size();
  for (const Ray& wall : walls)
    if (std::none_of(rays.begin(), rays.begin() + static_cast<std::ptrdiff_t>(measured),
                     [&](const Ray& r) { return between(r.angle_rad, wall.angle_rad) < kSeen_rad; }))
      rays.push_back(wall);
  std::stable_sort(rays.begin(), rays.end(),
                   [](const Ray& a, const Ray& b) { return a.angle_rad < b.angle_rad; });
  // Corners towards those of a superellipse of the same size: they correspond to those of other outlines.
  const auto reach = [&](double angle_rad) { return std::max(distance_at(rays, angle_rad), kLeast_m); };
  Outline out = superellipse({reach(0), reach(-kPi), reach(kPi / 2), reach(-kPi / 2)});
  for (Vec2& c : out.corners) {
    double a = std::atan2(c.y(), c.x());
    if (a >= kPi) a = -kPi;
    c = reach(a) * c.normalized();
  }
  return out;
}

Outline at_least(const Outline& outline, double least_m) {
  const Vec2 size = size_of(outline), middle = middle_of(outline);
  Outline out = outline;
  for (int axis = 0; axis < 2; ++axis)
    if (size[axis] < least_m)
      for (Vec2& c : out.corners)
        c[axis] = middle[axis] + (c[axis] - middle[axis]) * least_m / std::max(size[axis], kLeast_m);
  return out;
}

namespace {

Eigen::AlignedBox2d box_of_outline(const Outline& outline) {
  Eigen::AlignedBox2d box;
  for (const Vec2& c : outline.corners) box.extend(c);
  return box;
}

}  // namespace

Vec2 size_of(const Outline& outline) { return box_of_outline(outline).sizes(); }
Vec2 middle_of(const Outline& outline) { return box_of_outline(outline).center(); }

double distance_to(const Outline& a, const Outline& b, double t, const Vec2& p) {
  const auto corner = [&](std::size_t k) -> Vec2 { return a.corners[k] + t * (b.corners[k] - a.corners[k]); };
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = false;
  Vec2 from = corner(kCorners - 1) - p;
  for (std::size_t k = 0; k < kCorners; ++k) {
    const Vec2 to = corner(k) - p, edge = to - from;
    const double square = edge.squaredNorm();
    const double along = square > 0 ? std::clamp(-from.dot(edge) / square, 0.0, 1.0) : 0;
    nearest = std::min(nearest, (from + along * edge).squaredNorm());
    // Whether a ray along +x from p crosses the edge.
    if ((from.y() > 0) != (to.y() > 0)) {
      const double cross = from.x() * to.y() - from.y() * to.x();
      if ((to.y() > from.y()) == (cross > 0)) inside = !inside;
    }
    from = to;
  }
  return inside ? -std::sqrt(nearest) : std::sqrt(nearest);
}

}  // namespace karst::survey_cave
