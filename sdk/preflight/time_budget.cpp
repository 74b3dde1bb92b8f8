#include "sdk/preflight/time_budget.h"

#include <algorithm>

#include "core_stack/homing/path_home/home.h"

namespace karst::preflight {
namespace {

/// Home is the first hover; the ground lies below it by the take-off height.
double way_home_s(const TimeLimits& l, double length_m) {
  return core::home_time_s(length_m, 0, l.takeoff_height_m, l.motion, l.landing_speed_mps);
}

/// Climbs are no slower than the landing.
double way_out_s(const TimeLimits& l, double length_m) {
  return core::flight_time_s(length_m, l.motion) + l.takeoff_height_m / l.landing_speed_mps;
}

/// Time left at that place before the vehicle must turn back.
double slack_s(const TimeLimits& l, double endurance_s, double length_m) {
  return core::home_slack_s(endurance_s - way_out_s(l, length_m), way_home_s(l, length_m), l.home_margin,
                            l.home_reserve_s);
}

double reach_m(const TimeLimits& l, double endurance_s, double farthest_m) {
  if (slack_s(l, endurance_s, farthest_m) >= 0) return farthest_m;
  double near = 0, far = farthest_m;
  for (int i = 0; i < 60; ++i) {
    const double middle = (near + far) / 2;
    (slack_s(l, endurance_s, middle) >= 0 ? near : far) = middle;
  }
  return near;
}

}  // namespace

TimeBudget time_budget(const TimeLimits& limits, double farthest_m) {
  TimeBudget b;
  b.limits = limits;
  b.endurance_s = std::min(limits.battery_s.value_or(limits.max_flight_time_s), limits.max_flight_time_s);
  b.farthest_m = farthest_m;
  b.stride_m = core::cruise_speed_mps(limits.motion) * limits.decision_period_s;
  b.can_explore = slack_s(limits, b.endurance_s, 0) > 0;
  b.reach_m = b.can_explore ? reach_m(limits, b.endurance_s, farthest_m) : 0;
  b.home_s = way_home_s(limits, b.reach_m);
  b.turn_back_s =
      std::max(0.0, core::home_slack_s(b.endurance_s, b.home_s, limits.home_margin, limits.home_reserve_s));
  b.return_s = b.turn_back_s + b.home_s;
  return b;
}

}  // namespace karst::preflight
