#include "core_stack/mission/visibility.h"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "core_stack/mission/viewpoints.h"

namespace karst::core {
namespace {

/// A ledge or the height of a chamber may be climbed blind: every cell of the way has been seen, after all.
constexpr double kLedge_m = 3.0;
constexpr double kStep_m = 0.5;  // of the way looked at
constexpr double kDegree_rad = std::numbers::pi / 180;

/// Points of the polyline about kStep_m apart, its end included.
std::vector<Vec3> thinned(const std::vector<Vec3>& points) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (out.empty() || i + 1 == points.size() || (points[i] - out.back()).norm() >= kStep_m)
      out.push_back(points[i]);
  return out;
}

}  // namespace

SteepestView steepest_view(const VehicleDescription& vehicle) {
  constexpr double kNear_m = 1.5, kFar_m = 30;  // for cameras of any range; for a LiDAR that sits on a mast
  SteepestView view;
  for (int degree = 0; degree <= 90; ++degree) {
    const double e = degree * kDegree_rad;
    const auto sees = [&](double sign) {
      const Vec3 direction(std::cos(e), 0, sign * std::sin(e));
      return in_view(vehicle, {}, kNear_m * direction, 0) ||
             in_view(vehicle, {}, kFar_m * direction, 2 * kFar_m);
    };
    if (sees(1)) view.up_rad = e;
    if (sees(-1)) view.down_rad = e;
  }
  return view;
}

std::optional<std::string> blind_climb(const SteepestView& view, const std::vector<Vec3>& way_come,
                                       const std::vector<Vec3>& path) {
  const std::vector<Vec3> before = thinned(way_come), after = thinned(path);
  std::vector<Vec3> way = before;
  way.insert(way.end(), after.begin(), after.end());
  for (std::size_t to = before.size(); to < way.size(); ++to) {
    Vec3 low = way[to], high = way[to];
    double run_m = 0;
    for (std::size_t from = to; from-- > 0;) {
      run_m += (way[from + 1] - way[from]).norm();
      if (run_m > kClimbWindow_m) break;
      low = low.cwiseMin(way[from]), high = high.cwiseMax(way[from]);
      const double rise_m = way[to].z() - way[from].z(), extent_m = (high - low).head<2>().norm();
      const double limit_rad = rise_m > 0 ? view.up_rad : view.down_rad;
      if (std::abs(rise_m) <= kLedge_m || limit_rad > 89.5 * kDegree_rad ||
          extent_m * std::tan(limit_rad) >= std::abs(rise_m))
        continue;
      char text[200];
      std::snprintf(
          text, sizeof text,
          "it leads %.1f m %s within %.1f m at (%.1f, %.1f, %.1f), and no sensor of the vehicle looks "
          "steeper %s than %.0f deg",
          std::abs(rise_m), rise_m > 0 ? "up" : "down", extent_m, way[to].x(), way[to].y(), way[to].z(),
          rise_m > 0 ? "up" : "down", limit_rad / kDegree_rad);
      return text;
    }
  }
  return std::nullopt;
}

}  // namespace karst::core
