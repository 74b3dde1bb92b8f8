#include "core_stack/mission/decision/visibility.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "core_stack/mission/decision/viewpoints.h"

namespace karst::core {
namespace {

/// A ledge or the height of a chamber may be climbed blind, since every cell of the path has been observed.
constexpr double kLedge_m = 3.0;
constexpr double kStep_m = 0.5;  // between the path points checked
constexpr double kDegree_rad = std::numbers::pi / 180;

/// A height is not new within this horizontal distance of where the vehicle has been as high, or as low.
constexpr double kBeside_m = 4.0;
/// Tolerance for paths back, which are not flown to the centimetre. It applies only to heights reached more
/// than kClimbWindow_m of path ago: otherwise the vehicle could descend a shaft by this much at a time.
constexpr double kSameLevel_m = 0.5;

/// Resamples the polyline at about kStep_m, its end included.
std::vector<Vec3> thinned(const std::vector<Vec3>& points) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (out.empty() || i + 1 == points.size() || (points[i] - out.back()).norm() >= kStep_m)
      out.push_back(points[i]);
  return out;
}

/// The lowest and highest heights flown beside `p`.
struct Levels {
  double low_m = std::numeric_limits<double>::infinity(), high_m = -low_m;
};
Levels levels_beside(const Vec3& p, const std::vector<Vec3>& flown, std::size_t long_ago) {
  Levels l;
  for (std::size_t i = 0; i < flown.size(); ++i) {
    if ((flown[i] - p).head<2>().norm() > kBeside_m) continue;
    const double same_m = i < long_ago ? kSameLevel_m : 0;
    l = {std::min(l.low_m, flown[i].z() - same_m), std::max(l.high_m, flown[i].z() + same_m)};
  }
  return l;
}

/// How many of the points lie more than kClimbWindow_m of path before the last one.
std::size_t before_the_window(const std::vector<Vec3>& flight_path) {
  double run_m = 0;
  std::size_t i = flight_path.size();
  while (i > 1 && run_m <= kClimbWindow_m) {
    --i;
    run_m += (flight_path[i] - flight_path[i - 1]).norm();
  }
  return run_m > kClimbWindow_m ? i : 0;
}

}  // namespace

SteepestView steepest_view(const VehicleDescription& vehicle) {
  constexpr double kNear_m = 1.5, kFar_m = 30;  // for cameras of any range; for a LiDAR on a mast
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

std::optional<std::string> blind_climb(const SteepestView& view, const std::vector<Vec3>& flown_path,
                                       const std::vector<Vec3>& path) {
  const std::vector<Vec3> before = thinned(flown_path), after = thinned(path);
  std::vector<Vec3> flight_path = before;
  flight_path.insert(flight_path.end(), after.begin(), after.end());
  const std::size_t long_ago = before_the_window(before);
  for (std::size_t to = before.size(); to < flight_path.size(); ++to) {
    std::optional<Levels> flown;  // computed on first use
    Vec3 low = flight_path[to], high = flight_path[to];
    double run_m = 0;
    for (std::size_t from = to; from-- > 0;) {
      run_m += (flight_path[from + 1] - flight_path[from]).norm();
      if (run_m > kClimbWindow_m) break;
      low = low.cwiseMin(flight_path[from]);
      high = high.cwiseMax(flight_path[from]);
      const double rise_m = flight_path[to].z() - flight_path[from].z(),
                   extent_m = (high - low).head<2>().norm();
      const double limit_rad = rise_m > 0 ? view.up_rad : view.down_rad;
      if (std::abs(rise_m) <= kLedge_m || limit_rad > 89.5 * kDegree_rad ||
          extent_m * std::tan(limit_rad) >= std::abs(rise_m))
        continue;
      if (!flown) flown = levels_beside(flight_path[to], before, long_ago);
      if (rise_m > 0 ? flown->high_m >= flight_path[to].z() : flown->low_m <= flight_path[to].z()) continue;
      char text[200];
      std::snprintf(
          text, sizeof text,
          "it leads %.1f m %s within %.1f m at (%.1f, %.1f, %.1f), and no sensor of the vehicle looks "
          "steeper %s than %.0f deg",
          std::abs(rise_m), rise_m > 0 ? "up" : "down", extent_m, flight_path[to].x(), flight_path[to].y(),
          flight_path[to].z(), rise_m > 0 ? "up" : "down", limit_rad / kDegree_rad);
      return text;
    }
  }
  return std::nullopt;
}

}  // namespace karst::core
