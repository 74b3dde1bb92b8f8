// Scans with a known answer.
#pragma once
#include <cmath>
#include <limits>
#include <vector>

#include "core_stack/common/random.h"
#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core::scenes {

/// What octomap::OcTree uses unless told otherwise.
inline MapOptions octomap_options() { return {0.2, 0.7, 0.4, 0.12, 0.97}; }

/// Directions spread evenly over the sphere (Fibonacci lattice).
inline Vec3 direction(int i, int n) {
  const double z = 1.0 - 2.0 * (i + 0.5) / n, r = std::sqrt(1.0 - z * z), a = 2.399963229728653 * i;
  return {r * std::cos(a), r * std::sin(a), z};
}

/// Range from a point in the box [low, high] to its wall.
inline double range_in_box(const Vec3& p, const Vec3& d, const Vec3& low, const Vec3& high) {
  double t = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    if (d[a] > 0) t = std::min(t, (high[a] - p[a]) / d[a]);
    if (d[a] < 0) t = std::min(t, (low[a] - p[a]) / d[a]);
  }
  return t;
}

/// A scan of a closed box room with range noise; what lies beyond max_range_m is not seen.
inline std::vector<Ray> room_scan(const Vec3& origin, const Vec3& low, const Vec3& high, int n,
                                  double max_range_m, double noise_m, Random& random) {
  std::vector<Ray> rays;
  for (int i = 0; i < n; ++i) {
    const Vec3 d = direction(i, n);
    const double range = range_in_box(origin, d, low, high);
    const bool hit = range < max_range_m;
    const double measured = hit ? range + noise_m * random.normal() : max_range_m;
    rays.push_back({origin.cast<float>(), (origin + d * measured).cast<float>(), hit});
  }
  return rays;
}

/// Rays from around one place in all directions, of any length up to max_range_m, some without a hit.
inline std::vector<Ray> random_scan(Random& random, int n, double max_range_m) {
  const Vec3 origin(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3));
  std::vector<Ray> rays;
  for (int i = 0; i < n; ++i) {
    const Vec3 d = Vec3(random.normal(), random.normal(), random.normal()).normalized();
    const Vec3 end = origin + d * random.uniform(0, max_range_m);
    rays.push_back({origin.cast<float>(), end.cast<float>(), random.uniform() < 0.7});
  }
  return rays;
}

}  // namespace karst::core::scenes
