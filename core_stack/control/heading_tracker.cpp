#include "core_stack/control/heading_tracker.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/geometry.h"

namespace karst::core {

HeadingState step_heading(const HeadingState& s, double target_rad, double target_rate_radps,
                          const HeadingLimits& limits, double dt_s) {
  // The rate at which an error e can still be braked away with half of the acceleration is sqrt(a |e|); below
  // e = a T^2 a linear approach with time constant T meets it and does not chatter.
  constexpr double kApproach_s = 0.15;
  const double error = wrap_angle(target_rad - target_rate_radps * dt_s - s.heading_rad);  // before the step
  const double closing =
      std::min(std::sqrt(limits.max_acceleration_radps2 * std::abs(error)), std::abs(error) / kApproach_s);
  const double wanted = std::clamp(target_rate_radps + std::copysign(closing, error), -limits.max_rate_radps,
                                   limits.max_rate_radps);
  const double change = limits.max_acceleration_radps2 * dt_s;
  HeadingState next;
  next.rate_radps = s.rate_radps + std::clamp(wanted - s.rate_radps, -change, change);
  next.heading_rad = wrap_angle(s.heading_rad + 0.5 * (s.rate_radps + next.rate_radps) * dt_s);
  return next;
}

}  // namespace karst::core
