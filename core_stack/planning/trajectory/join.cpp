#include "core_stack/planning/trajectory/join.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace karst::core {
namespace {

/// Distances from the corner at which the parabola may begin and end; the longest suitable one is used.
constexpr std::array kJoinLengths_m = {2.4, 1.6, 1.0, 0.6, 0.3};
constexpr double kSpacing_m = 0.1;
constexpr double kStraight_rad = 0.03;

double turn_rad(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// The point `along_m` along a polyline, and the index of the vertex after it.
struct JoinPoint {
  Vec3 point;
  std::size_t next;
};

std::optional<JoinPoint> after(const std::vector<Vec3>& points, double along_m) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double step_m = (points[i] - points[i - 1]).norm();
    if (step_m > along_m)
      return JoinPoint{points[i - 1] + (points[i] - points[i - 1]) * (along_m / step_m), i};
    along_m -= step_m;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Vec3> join_paths(
    const std::vector<Vec3>& committed, const std::vector<Vec3>& path, double max_cut_m,
    const std::function<bool(const Vec3&, const Vec3&)>& clear,
    const std::function<bool(const std::vector<Vec3>&, const std::vector<Vec3>&)>& can_be_flown) {
  std::vector<Vec3> plain = committed;
  plain.insert(plain.end(), path.begin() + 1, path.end());
  if (committed.size() < 2 || path.size() < 2) return plain;
  const Vec3& corner = committed.back();
  const double kink = turn_rad(corner - committed[committed.size() - 2], path[1] - corner);
  if (kink < kStraight_rad) return plain;
  const std::vector<Vec3> backwards(committed.rbegin(), committed.rend());
  for (const double along_m : kJoinLengths_m) {
    const auto begin = after(backwards, along_m), end = after(path, along_m);
    if (!begin || !end) continue;
    if (0.25 * (begin->point + end->point - 2 * corner).norm() > max_cut_m) continue;
    std::vector<Vec3> curve;
    const int n = static_cast<int>(std::ceil(2 * along_m / kSpacing_m));
    for (int i = 0; i <= n; ++i) {
      const double t = static_cast<double>(i) / n, u = 1 - t;
      curve.push_back(u * u * begin->point + 2 * u * t * corner + t * t * end->point);
    }
    // If the committed segment or the path bends near the corner, the parabola has corners of its own at its
    // ends.
    const double own =
        std::max(turn_rad(backwards[begin->next - 1] - backwards[begin->next], corner - begin->point),
                 turn_rad(end->point - corner, path[end->next] - path[end->next - 1]));
    if (own > 0.5 * kink) continue;
    bool all_clear = true;
    for (std::size_t i = 1; i < curve.size() && all_clear; ++i) all_clear = clear(curve[i - 1], curve[i]);
    if (!all_clear) continue;
    std::vector<Vec3> out(committed.begin(), committed.end() - static_cast<std::ptrdiff_t>(begin->next));
    out.insert(out.end(), curve.begin(), curve.end());
    out.insert(out.end(), path.begin() + static_cast<std::ptrdiff_t>(end->next), path.end());
    if (can_be_flown(out, plain)) return out;
  }
  return plain;
}

}  // namespace karst::core
