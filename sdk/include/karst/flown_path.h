// The flown path as a policy knows it: the polyline through the vehicle's positions at each decision.
#pragma once
#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include <karst/policy.h>

namespace karst {

class FlownPath {
 public:
  void note(const Vec3& position) {
    if (points_.empty() || distance(points_.back(), position) > step_m) points_.push_back(position);
  }

  /// Distance from `p` (world, m) to the polyline; infinity before the first decision.
  double distance_m(const Vec3& p) const {
    if (points_.empty()) return std::numeric_limits<double>::infinity();
    double min_m = distance(p, points_.front());
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const Vec3 along = points_[i] - points_[i - 1], from = p - points_[i - 1];
      const double t = std::clamp(dot(from, along) / dot(along, along), 0.0, 1.0);
      min_m = std::min(min_m, norm(from - t * along));
    }
    return min_m;
  }

 private:
  static constexpr double step_m = 0.3;
  std::vector<Vec3> points_;
};

}  // namespace karst
