#include "core_stack/planning/path/refine.h"

#include <algorithm>

#include "core_stack/planning/free_space/free_tiles.h"
#include "core_stack/planning/path/elastic_band.h"
#include "core_stack/planning/path/round_corners.h"

namespace karst::core {
namespace {

/// Step lengths, from the first to the last, for moving path points away from obstacles.
constexpr double kLiftStep_m = 0.04, kMinLiftStep_m = 0.004;
/// Extra clearance of the moved points, so that the lines between them are clear, too.
constexpr double kLiftSlack_m = 0.02;
/// Spacing of the band's points; the spacing of the finished path is at most `kFineSpacing_m`.
constexpr double kBandSpacing_m = 0.4;
constexpr double kFineSpacing_m = 0.1;
/// A path with more clearance may be longer than the given one by this factor (the given one zigzags).
constexpr double kMaxLonger = 1.05;

/// Points at most `spacing_m` apart along the same polyline, its vertices included.
std::vector<Vec3> densified(const std::vector<Vec3>& points, double spacing_m) {
  std::vector<Vec3> out{points.front()};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec3 d = points[i] - points[i - 1];
    const int n = std::max(1, static_cast<int>(std::ceil(d.norm() / spacing_m)));
    for (int k = 1; k < n; ++k) out.push_back(points[i - 1] + d * k / n);
    out.push_back(points[i]);
  }
  return out;
}

/// Moves inner points nearer to obstacles than the clearance to a larger distance, along the best of 26
/// directions with decreasing steps: following the gradient of the distance to the nearest obstacle would
/// oscillate between the two sides of a narrow passage.
void lift(const FreeTiles& free, double clearance_m, std::vector<Vec3>& points) {
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    double distance = free.nearest(points[i], clearance_m).distance_m;
    for (double step = kLiftStep_m; step > kMinLiftStep_m && distance < clearance_m;) {
      Vec3 best = points[i];
      for (int m = 0; m < 27; ++m) {
        const int x = m % 3 - 1, y = m / 3 % 3 - 1, z = m / 9 - 1;
        const Vec3 q = points[i] + step * Vec3(x, y, z);
        const double d = free.nearest(q, clearance_m).distance_m;
        if (d > distance + 1e-6 && free.at(free.key_of(q))) {
          distance = d;
          best = q;
        }
      }
      if (best == points[i]) step /= 2;
      points[i] = best;
    }
  }
}

/// Shortens the path: connects each point to the farthest later point on a clear line.
std::vector<Vec3> pulled(const FreeTiles& free, double clearance_m, const std::vector<Vec3>& points) {
  std::vector<Vec3> out{points.front()};
  const std::size_t last = points.size() - 1;
  for (std::size_t i = 0; i < last;) {
    std::size_t reached = i + 1, step = 1;
    while (step > 0) {  // doubles the stride, then halves it
      const std::size_t next = std::min(last, reached + step);
      const bool clear = next > reached && free.segment_clear(points[i], points[next], clearance_m);
      if (clear) reached = next;
      step = clear && step < 64 ? step * 2 : step / 2;
    }
    out.push_back(points[reached]);
    i = reached;
  }
  return out;
}

std::vector<Vec3> shortened(const FreeTiles& free, double clearance_m, std::vector<Vec3> points) {
  // Forwards, then backwards with finer spacing: a corner found late in one direction is found early in the
  // other.
  for (int pass = 0; pass < 2; ++pass) {
    points = pulled(free, clearance_m, densified(points, 0.5 * kBandSpacing_m));
    std::reverse(points.begin(), points.end());
  }
  return points;
}

}  // namespace

std::vector<Vec3> refine_path(const VoxelMap& map, const std::vector<Vec3>& points,
                              const PlanningOptions& options) {
  if (points.size() < 2) return points;
  const double preferred = std::max(options.clearance_m, options.preferred_clearance_m);
  FreeTiles free(map.resolution_m());
  // The band stays within its maximal push of the shortened path, so this covers all its queries.
  for (const Vec3& p : densified(points, map.resolution_m()))
    free.load_near(map, p, 2 * preferred + 2 * map.resolution_m());
  return refine_path(free, points, options);
}

std::vector<Vec3> refine_path(const FreeTiles& free, const std::vector<Vec3>& points,
                              const PlanningOptions& options) {
  if (points.size() < 2) return points;
  const double clearance = options.clearance_m,
               preferred = std::max(clearance, options.preferred_clearance_m);

  // The escape from a tight place at the beginning stays unchanged.
  std::size_t kept = 0;
  const double escape_m = search_clearance_m(options, free.resolution_m()) - 1e-6;
  while (kept + 1 < points.size() && !free.is_clear(points[kept], escape_m)) ++kept;
  std::vector<Vec3> rest =
      densified({points.begin() + static_cast<std::ptrdiff_t>(kept), points.end()}, free.resolution_m());
  const double raw_length = path_length_m(rest);
  std::vector<Vec3> best;
  if (rest.size() >= 2) {
    lift(free, clearance + kLiftSlack_m, rest);
    rest = densified(rest, kFineSpacing_m);
    lift(free, clearance + kLiftSlack_m, rest);
    const std::vector<Vec3> string = shortened(free, clearance, rest);
    best = string;
    for (const double fraction : {1.0, 0.6, 0.3, 0.0}) {
      const std::vector<Vec3> band = smooth_band(
          free, clearance, clearance + fraction * (preferred - clearance), densified(string, kBandSpacing_m));
      std::vector<Vec3> fine = fine_curve(free, clearance, band, kFineSpacing_m);
      if (path_length_m(fine) <= kMaxLonger * raw_length) {
        best = std::move(fine);
        break;
      }
    }
    best = round_corners(free, clearance, densified(best, kFineSpacing_m));
  }
  std::vector<Vec3> out(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(kept));
  out.insert(out.end(), best.begin(), best.end());
  if (best.empty()) out.push_back(points.back());
  return out;
}

}  // namespace karst::core
