#include "sdk/survey_export/stations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core_stack/planning/free_space/free_way.h"
#include "sdk/survey_export/median.h"

namespace karst::survey_export {
namespace {

using core::Vec3;

class Choice {
 public:
  Choice(const core::VoxelMap& map, const MiddleLine& line, const StationOptions& options)
      : map_(map), points_(line.points), options_(options), along_m_(points_.size()), sizes_(points_.size()) {
    for (std::size_t i = 1; i < points_.size(); ++i)
      along_m_[i] = along_m_[i - 1] + (points_[i].position - points_[i - 1].position).norm();
    std::vector<std::size_t> measured;
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (!points_[i].detour) measured.push_back(i);
    std::size_t first = 0;
    for (const std::size_t i : measured) {
      while (along_m_[i] - along_m_[measured[first]] > kAround_m) ++first;
      std::vector<double> widths, heights;
      for (std::size_t m = first; m < measured.size(); ++m) {
        if (along_m_[measured[m]] - along_m_[i] > kAround_m) break;
        widths.push_back(points_[measured[m]].width_m);
        heights.push_back(points_[measured[m]].height_m);
      }
      sizes_[i] = {median(std::move(widths)), median(std::move(heights))};
    }
  }

  std::vector<std::size_t> chosen() const {
    const std::size_t n = points_.size();
    constexpr double kLeg = 1e9;   // outweighs all squares of lengths
    constexpr double kBend = 1e3;  // an even length matters less than a station at the bend itself
    std::vector<double> cost(n, std::numeric_limits<double>::infinity());
    std::vector<std::size_t> from(n, 0);
    cost[0] = 0;
    for (std::size_t i = 0; i + 1 < n; ++i)
      for (std::size_t k = i + 1; k < n; ++k) {
        const double length_m = along_m_[k] - along_m_[i];
        if (k > i + 1 && length_m > options_.longest_leg_m) break;
        const std::optional<double> off_m2 = k > i + 1 ? bend_m2(i, k) : 0.0;
        if (!off_m2) continue;
        const double total = cost[i] + kLeg + kBend * *off_m2 + length_m * length_m;
        if (total >= cost[k]) continue;
        cost[k] = total;
        from[k] = i;
      }
    std::vector<std::size_t> out;
    for (std::size_t k = n - 1; k != 0; k = from[k]) out.push_back(k);
    out.push_back(0);
    std::reverse(out.begin(), out.end());
    return out;
  }

 private:
  static constexpr double kAround_m = 1.6;  // to either side of a point: its size is the median of these

  struct Size {
    double width_m = 0, height_m = 0;
  };

  /// Sum of the squares of the distances by which the points between are off a leg from `i` to `k`. None if
  /// there may be no such leg.
  std::optional<double> bend_m2(std::size_t i, std::size_t k) const {
    const Vec3& a = points_[i].position;
    const Vec3 leg = points_[k].position - a;
    if (leg.norm() < 1e-6) return std::nullopt;
    double sum_m2 = 0;
    for (std::size_t m = i + 1; m < k; ++m) {
      const LinePoint& p = points_[m];
      if (p.detour) continue;
      const double f = std::clamp((p.position - a).dot(leg) / leg.squaredNorm(), 0.0, 1.0);
      const double off_m = (p.position - (a + f * leg)).norm();
      if (off_m > std::max(options_.least_bend_m, options_.bend_fraction * p.width_m)) return std::nullopt;
      sum_m2 += off_m * off_m;
      if (differs(sizes_[m].width_m, between(points_[i].width_m, points_[k].width_m, f)) ||
          differs(sizes_[m].height_m, between(points_[i].height_m, points_[k].height_m, f)))
        return std::nullopt;
    }
    if (!sees(map_, a, points_[k].position)) return std::nullopt;
    return sum_m2;
  }
  static double between(double a, double b, double f) { return a + f * (b - a); }
  bool differs(double size_m, double expected_m) const {
    return std::abs(size_m - expected_m) >
           std::max(options_.least_change_m, options_.change_fraction * size_m);
  }

  const core::VoxelMap& map_;
  const std::vector<LinePoint>& points_;
  const StationOptions& options_;
  std::vector<double> along_m_;
  std::vector<Size> sizes_;  // smoothed; of measured points
};

}  // namespace

std::vector<std::size_t> stations_on(const core::VoxelMap& map, const MiddleLine& line,
                                     const StationOptions& options) {
  if (line.points.size() < 2) return {};
  return Choice(map, line, options).chosen();
}

}  // namespace karst::survey_export
