// The way the vehicle came: its last resort for the way home.
#pragma once
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

class WayFlown {
 public:
  /// From the first hover.
  void begin(const Vec3& hover) { points_ = {hover}; }
  bool begun() const { return !points_.empty(); }
  /// The vehicle is here now; a place every quarter of a metre is kept.
  void note(const Vec3& here) {
    constexpr double kStep_m = 0.25;
    const double step_m = (points_.back() - here).norm();
    if (step_m <= kStep_m) return;
    length_m_ += step_m;
    points_.push_back(here);
  }
  const std::vector<Vec3>& points() const { return points_; }
  double length_m() const { return length_m_; }

 private:
  std::vector<Vec3> points_;
  double length_m_ = 0;
};

}  // namespace karst::core
