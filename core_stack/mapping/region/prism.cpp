#include "core_stack/mapping/region/prism.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/format_text.h"

namespace karst::core {
namespace {

using Point = Eigen::Vector2d;

/// Corners nearer than this coincide, and edges nearer than this touch.
constexpr double kSame_m = 1e-6;

struct Edge {
  Point a, b;
};

Edge edge(const Outline& outline, std::size_t i) { return {outline[i], outline[(i + 1) % outline.size()]}; }

double distance_m(const Edge& e, const Point& p) {
  const Point along = e.b - e.a;
  const double t = std::clamp((p - e.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (e.a + t * along - p).norm();
}

double side(const Edge& e, const Point& p) {
  const Point u = e.b - e.a, v = p - e.a;
  return u.x() * v.y() - u.y() * v.x();
}

bool cross_or_touch(const Edge& e, const Edge& f) {
  const bool cross = (side(e, f.a) > 0) != (side(e, f.b) > 0) && (side(f, e.a) > 0) != (side(f, e.b) > 0);
  return cross ||
         std::min({distance_m(e, f.a), distance_m(e, f.b), distance_m(f, e.a), distance_m(f, e.b)}) < kSame_m;
}

double area_m2(const Outline& outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Edge e = edge(outline, i);
    twice += (e.a.x() - outline[0].x()) * (e.b.y() - outline[0].y()) -
             (e.b.x() - outline[0].x()) * (e.a.y() - outline[0].y());
  }
  return std::abs(twice) / 2;
}

/// By the number of edges that a ray to the east crosses.
bool inside(const Outline& outline, const Point& p) {
  bool in = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Edge e = edge(outline, i);
    if ((e.a.y() > p.y()) != (e.b.y() > p.y()) &&
        p.x() < e.a.x() + (p.y() - e.a.y()) / (e.b.y() - e.a.y()) * (e.b.x() - e.a.x()))
      in = !in;
  }
  return in;
}

double depth_in(const Outline& outline, const Point& p) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i)
    nearest_m = std::min(nearest_m, distance_m(edge(outline, i), p));
  return inside(outline, p) ? nearest_m : -nearest_m;
}

std::string text(const Point& p) { return format_text("(%g, %g)", p.x(), p.y()); }

}  // namespace

Prism box(const Vec3& a, const Vec3& b) {
  const Vec3 low = a.cwiseMin(b), high = a.cwiseMax(b);
  return {{{low.x(), low.y()}, {high.x(), low.y()}, {high.x(), high.y()}, {low.x(), high.y()}},
          low.z(),
          high.z()};
}

std::optional<std::string> flaw_of(const Prism& prism) {
  const Outline& o = prism.outline;
  if (o.size() < 3)
    return "a polygon has at least three corners, and this one has " + std::to_string(o.size());
  if (!(prism.low_m < prism.high_m))
    return format_text("its lowest height, %g m, is not below its highest, %g m", prism.low_m, prism.high_m);
  for (std::size_t i = 0; i < o.size(); ++i)
    if ((edge(o, i).b - edge(o, i).a).norm() < kSame_m)
      return "two corners in succession lie at " + text(o[i]);
  for (std::size_t i = 0; i < o.size(); ++i)
    for (std::size_t j = i + 1; j < o.size(); ++j) {
      const bool neighbours = j == i + 1 || (i == 0 && j + 1 == o.size());
      const Edge e = edge(o, i), f = edge(o, j);
      // Edges with a common corner may meet nowhere else: one would run back along the other.
      const bool meet = !neighbours  ? cross_or_touch(e, f)
                        : j == i + 1 ? distance_m(e, f.b) < kSame_m || distance_m(f, e.a) < kSame_m
                                     : distance_m(e, f.a) < kSame_m || distance_m(f, e.b) < kSame_m;
      if (meet)
        return "its edge from " + text(e.a) + " to " + text(e.b) + " meets the one from " + text(f.a) +
               " to " + text(f.b);
    }
  if (area_m2(o) < kSame_m) return std::string("it has no area");
  return std::nullopt;
}

double depth_in(const Prism& prism, const Vec3& p) {
  const double across_m = depth_in(prism.outline, Point(p.x(), p.y()));
  const double upright_m = std::min(p.z() - prism.low_m, prism.high_m - p.z());
  if (across_m >= 0 || upright_m >= 0) return std::min(across_m, upright_m);
  return -std::hypot(across_m, upright_m);
}

}  // namespace karst::core
