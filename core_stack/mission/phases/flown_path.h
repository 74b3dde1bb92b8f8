// The flown path: the last resort for the return home.
#pragma once
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

class FlownPath {
 public:
  /// Starts at the first hover.
  void begin(const Vec3& hover) { points_ = {hover}; }
  bool begun() const { return !points_.empty(); }
  /// Adds the vehicle's position; keeps a point every quarter of a metre.
  void note(const Vec3& here) {
    constexpr double kStep_m = 0.25;
    const double step_m = (points_.back() - here).norm();
    if (step_m <= kStep_m) return;
    length_m_ += step_m;
    points_.push_back(here);
  }
  const std::vector<Vec3>& points() const { return points_; }
  double length_m() const { return length_m_; }
  /// The last `length_m` of the path, backwards from its end, with a point every metre.
  std::vector<Vec3> back(double length_m) const {
    constexpr double kApart_m = 1;
    std::vector<Vec3> out;
    for (std::size_t i = points_.size(); i-- > 0 && length_m > 0;) {
      const double step_m = out.empty() ? 0 : (points_[i] - out.back()).norm();
      if (!out.empty() && i > 0 && step_m < kApart_m) continue;
      out.push_back(points_[i]);
      length_m -= step_m;
    }
    return out;
  }

 private:
  std::vector<Vec3> points_;
  double length_m_ = 0;
};

}  // namespace karst::core
