// Heading of the virtual vehicle: follows a moving target along the shorter arc, its rate and acceleration
// limited.
#pragma once

namespace karst::core {

struct HeadingState {
  double heading_rad = 0;
  double rate_radps = 0;
};

struct HeadingLimits {
  double max_rate_radps = 1;
  double max_acceleration_radps2 = 2;
};

/// `s` after `dt_s`, the target being at `target_rad` then and turning at `target_rate_radps`.
HeadingState step_heading(const HeadingState& s, double target_rad, double target_rate_radps,
                          const HeadingLimits& limits, double dt_s);

}  // namespace karst::core
