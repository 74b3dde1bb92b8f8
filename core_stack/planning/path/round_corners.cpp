#include "core_stack/planning/path/round_corners.h"

#include <algorithm>

namespace karst::core {
namespace {

constexpr std::size_t kHalfWindow = 3;

/// Each point becomes the mean of those up to `half[i]` before and after it.
std::vector<Vec3> averaged(const std::vector<Vec3>& points, const std::vector<std::size_t>& half) {
  std::vector<Vec3> sums{Vec3::Zero()}, out;
  for (const Vec3& p : points) sums.push_back(sums.back() + (p - points.front()));
  for (std::size_t i = 0; i < points.size(); ++i)
    out.push_back(half[i] == 0 ? points[i]
                               : points.front() + (sums[i + half[i] + 1] - sums[i - half[i]]) /
                                                      static_cast<double>(2 * half[i] + 1));
  return out;
}

}  // namespace

std::vector<Vec3> round_corners(const FreeTiles& free, double clearance_m, const std::vector<Vec3>& points) {
  if (points.empty()) return points;
  std::vector<std::size_t> half(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) half[i] = std::min({kHalfWindow, i, points.size() - 1 - i});
  for (;;) {
    const std::vector<Vec3> round = averaged(averaged(points, half), half);
    bool narrowed = false;
    std::vector<std::size_t> next = half;
    for (std::size_t i = 0; i + 1 < round.size(); ++i) {
      if (free.segment_clear(round[i], round[i + 1], clearance_m)) continue;
      // The segment depends on the points that two averages reach.
      const std::size_t reach = 2 * kHalfWindow;
      for (std::size_t k = i < reach ? 0 : i - reach; k < std::min(round.size(), i + 2 + reach); ++k)
        if (half[k] > 0 && next[k] == half[k]) {
          next[k] = half[k] / 2;
          narrowed = true;
        }
    }
    if (!narrowed) return round;
    half = std::move(next);
  }
}

}  // namespace karst::core
