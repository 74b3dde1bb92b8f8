// How long a flight may last, and when it is back: the rule by which the vehicle turns back in flight
// (core::home_slack_s), applied to the cave's farthest place before take-off.
#pragma once
#include <optional>

#include "core_stack/planning/trajectory/trajectory.h"

namespace karst::preflight {

struct TimeLimits {
  std::optional<double> battery_s;  // hovering time of a full battery; nothing if it is not known
  double max_flight_time_s = 3600;
  double home_margin = 0.15;  // of the time home
  double home_reserve_s = 20;
  double decision_period_s = 4;
  double takeoff_height_m = 0.7;
  double landing_speed_mps = 0.4;
  core::MotionLimits motion;
};

struct TimeBudget {
  TimeLimits limits;
  double endurance_s = 0;   // the lesser of battery and flight time allowed
  double farthest_m = 0;    // way home from the farthest place of the cave
  double reach_m = 0;       // way home from the farthest place from which the vehicle can still fly home
  double home_s = 0;        // to fly home from there and land
  double turn_back_s = 0;   // after take-off, when it must turn back there
  double return_s = 0;      // after take-off, when it then has landed
  double stride_m = 0;      // what the vehicle flies between two decisions
  bool can_explore = true;  // false: no time is left to fly anywhere and back

  bool reaches_all() const { return reach_m >= farthest_m; }
  /// Nearer than a stride, nothing is seen that is not seen from the start, and goals are refused as too far.
  bool explores() const { return can_explore && (reaches_all() || reach_m >= stride_m); }
};

/// With endurance T, margin m and reserve r, the vehicle turns back when T - t = (1 + m) home_s + r. At the
/// place from which the way home is d, that leaves t = T - r - (1 + m) home_s(d). The place can be reached if
/// the flight there, no longer than the way home, takes at most t.
TimeBudget time_budget(const TimeLimits& limits, double farthest_m);

}  // namespace karst::preflight
