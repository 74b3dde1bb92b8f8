#include "sdk/cave_drawing/fill_polygon.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace karst::cave_drawing {
namespace {

double turn(const Point& a, const Point& b, const Point& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

}  // namespace

Line convex_hull(std::vector<Point> points) {
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return std::tuple(a.x(), a.y()) < std::tuple(b.x(), b.y());
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  Line hull;
  const auto add = [&](const Point& p, std::size_t least) {
    while (hull.size() >= least && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
    hull.push_back(p);
  };
  for (const Point& p : points) add(p, 2);
  const std::size_t lower = hull.size() + 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, lower);
  hull.pop_back();  // where it began
  return hull;
}

void fill_convex(CellMask& mask, const Line& hull) {
  if (hull.size() < 3) return;
  double low = hull.front().y(), high = low;
  for (const Point& p : hull) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  const int first = std::max(mask.low_y(), static_cast<int>(std::floor(low)));
  const int last = std::min(mask.high_y(), static_cast<int>(std::ceil(high)));
  for (int y = first; y <= last; ++y) {
    const double level = y + 0.5;
    double left = 1, right = 0;
    bool any = false;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Point &a = hull[i], &b = hull[(i + 1) % hull.size()];
      if ((a.y() <= level) == (b.y() <= level)) continue;
      const double x = a.x() + (level - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      left = any ? std::min(left, x) : x;
      right = any ? std::max(right, x) : x;
      any = true;
    }
    if (!any) continue;
    for (int x = static_cast<int>(std::ceil(left - 0.5)); x + 0.5 <= right; ++x) mask.set(x, y);
  }
}

void fill_disc(CellMask& mask, const Point& middle, double radius) {
  constexpr int kCorners = 32;
  Line ring;
  for (int i = 0; i < kCorners; ++i) {
    const double a = 2 * std::numbers::pi * i / kCorners;
    ring.push_back(middle + radius * Point(std::cos(a), std::sin(a)));
  }
  fill_convex(mask, ring);
}

}  // namespace karst::cave_drawing
