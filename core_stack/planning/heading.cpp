#include "core_stack/planning/heading.h"

#include <algorithm>
#include <cmath>

namespace karst::core {

double HeadingCourse::step(double wanted_rad) {
  const double error = wrap_angle(wanted_rad - heading_rad_);
  const double alpha = limits_.max_heading_acceleration_radps2;
  // The fastest rate from which the turn can still stop at the wanted heading, in whole steps of the period:
  // braking by alpha * period a step covers rate^2 / (2 alpha) + rate * period / 2.
  const double half = 0.5 * alpha * period_s_;
  const double braking = std::sqrt(half * half + 2 * alpha * std::abs(error)) - half;
  double rate = std::min({limits_.max_heading_rate_radps, braking, std::abs(error) / period_s_});
  rate = std::copysign(rate, error);
  rate_radps_ = std::clamp(rate, rate_radps_ - alpha * period_s_, rate_radps_ + alpha * period_s_);
  heading_rad_ = wrap_angle(heading_rad_ + rate_radps_ * period_s_);
  return heading_rad_;
}

std::vector<double> headings_along(const std::vector<Vec3>& points, double lookahead_m,
                                   double start_heading_rad) {
  constexpr double steepest = 0.25;  // horizontal share of a direction that still has a heading
  std::vector<double> out;
  double heading = start_heading_rad;
  std::size_t ahead = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    while (ahead + 1 < points.size() && (points[ahead] - points[i]).norm() < lookahead_m) ++ahead;
    const Vec3 d = points[ahead] - points[i];
    // Near the end what lies ahead is too short to give a direction: keep the last.
    const double horizontal = std::hypot(d.x(), d.y());
    if (horizontal > steepest * d.norm() && (d.norm() > 0.5 * lookahead_m || i == 0) && horizontal > 1e-6)
      heading = std::atan2(d.y(), d.x());
    out.push_back(heading);
  }
  return out;
}

}  // namespace karst::core
