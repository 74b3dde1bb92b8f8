// Heading along a trajectory: what it should be, and a course to it within the limits of turning.
#pragma once
#include <vector>

#include "core_stack/planning/trajectory.h"

namespace karst::core {

/// Brings a heading to wanted values within rate and acceleration limits, one step a sample.
class HeadingCourse {
 public:
  HeadingCourse(double heading_rad, const MotionLimits& limits, double period_s)
      : heading_rad_(heading_rad), limits_(limits), period_s_(period_s) {}
  double step(double wanted_rad);
  double heading_rad() const { return heading_rad_; }
  double rate_radps() const { return rate_radps_; }

 private:
  double heading_rad_, rate_radps_ = 0;
  MotionLimits limits_;
  double period_s_;
};

/// Direction of travel seen from above at each of `points` (evenly spaced along the path): towards the point
/// `lookahead_m` farther on. Where the path is steep the last heading is kept, at the start
/// `start_heading_rad`.
std::vector<double> headings_along(const std::vector<Vec3>& points, double lookahead_m,
                                   double start_heading_rad);

}  // namespace karst::core
