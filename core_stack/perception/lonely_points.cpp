#include "core_stack/perception/lonely_points.h"

#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core_stack/common/direction_cells.h"

namespace karst::core {
namespace {

constexpr float kPointWindow_rad = 0.06f, kPointCell_rad = 0.03f;
constexpr std::size_t kMostPoints = 16;  // looked at around each
constexpr float kPointTolerancePerMetre = 0.006f, kPointSlope = 0.3f;
constexpr int kFewestPoints = 3;
constexpr float kOpposite = -0.8f;  // cosine between the offsets of two neighbours
constexpr float kHalfIntensity_m = 25;

struct Around {
  Vec3f offset;  // of the unit vectors
  float angle_rad, range_m;
};

bool lies_on_plane(float range_m, const Around& a, const Around& b, float tolerance_m) {
  if (a.offset.dot(b.offset) > kOpposite * a.angle_rad * b.angle_rad) return false;
  const float inverse = (b.angle_rad / a.range_m + a.angle_rad / b.range_m) / (a.angle_rad + b.angle_rad);
  return std::abs(inverse - 1 / range_m) * range_m * range_m <
         tolerance_m + kPointTolerancePerMetre * range_m;
}

/// How many of them lie on a surface with a point of this range: at its level, or on a plane with another.
int count_agreeing(std::span<const Around> around, float range_m, float tolerance_m) {
  std::array<bool, kMostPoints> agrees{};
  for (std::size_t i = 0; i < around.size(); ++i) {
    const float level_m = tolerance_m + kPointSlope * around[i].angle_rad * range_m;
    if (std::abs(around[i].range_m - range_m) < level_m) agrees[i] = true;
    for (std::size_t j = 0; j < i; ++j)
      if (!(agrees[i] && agrees[j]) && lies_on_plane(range_m, around[i], around[j], tolerance_m))
        agrees[i] = agrees[j] = true;
  }
  int count = 0;
  for (std::size_t i = 0; i < around.size(); ++i) count += agrees[i];
  return count;
}

}  // namespace

void drop_lonely_points(LidarScan& scan, const LonelyReturnOptions& o) {
  if (!scan.fits_model() || scan.intensity.size() != scan.range_m.size()) return;
  const auto radius_m = static_cast<float>(o.radius_m), tolerance_m = static_cast<float>(o.tolerance_m),
             fraction = static_cast<float>(o.agreement), bright = static_cast<float>(o.bright);
  const DirectionCells cells(scan.direction, kPointCell_rad);
  const auto is_return = [](float range_m) { return std::isfinite(range_m) && range_m > 0; };
  // As with rings: what the first round drops agrees with nobody in the second, but is still there.
  const std::vector<float> first_m = scan.range_m;
  for (const int round : {0, 1}) {
    const std::vector<float> before_m = round == 0 ? first_m : scan.range_m;
    for (std::size_t i = 0; i < before_m.size(); ++i) {
      const float range_m = before_m[i], x = range_m / kHalfIntensity_m;
      if (!(range_m < radius_m) || scan.intensity[i] * (1 + x * x) >= bright) continue;
      std::array<Around, kMostPoints> around;
      std::size_t n = 0;
      int there = 0;
      std::size_t candidates = 0;
      cells.for_each_run(scan.direction[i], kPointWindow_rad,
                         [&](std::size_t first, std::size_t end) { candidates += end - first; });
      const std::size_t step = std::max<std::size_t>(1, candidates / (2 * kMostPoints));
      cells.for_each_run(scan.direction[i], kPointWindow_rad, [&](std::size_t first, std::size_t end) {
        for (std::size_t at = first; at < end && n < kMostPoints; at += step) {
          const std::size_t j = cells.order()[at];
          const Vec3f offset = scan.direction[j] - scan.direction[i];
          const float angle_rad = offset.norm();
          if (j == i || !is_return(first_m[j]) || angle_rad > kPointWindow_rad || angle_rad == 0) continue;
          ++there;
          if (is_return(before_m[j])) around[n++] = {offset, angle_rad, before_m[j]};
        }
      });
      const int agree = count_agreeing({around.data(), n}, range_m, tolerance_m);
      if (there < kFewestPoints || static_cast<float>(agree) < fraction * static_cast<float>(there))
        scan.range_m[i] = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

}  // namespace karst::core
