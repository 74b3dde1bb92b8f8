// Where a flight lost time against one at full speed: what it slowed down for, and what it stood for.
#pragma once
#include <array>
#include <limits>
#include <optional>

#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

/// What a vehicle slows down for.
enum class SlowdownCause {
  bend,     // the acceleration across the path is near its limit
  heading,  // the heading rate is near its limit, and the vehicle faces the direction of flight
  stop,     // it comes to rest
  other,    // rock or another vehicle near, sensors degraded, a narrow passage
};
constexpr auto names_of(SlowdownCause) {
  using enum SlowdownCause;
  return std::to_array<core::Named<SlowdownCause>>({{bend, "bends"},
                                                    {heading, "limits of the heading rate"},
                                                    {stop, "stops"},
                                                    {other, "other slow places"}});
}

/// Seconds lost, of a slowdown: at its slowest part, while braking for it, and while speeding up after it.
struct Slowdown {
  double at_s = 0, before_s = 0, after_s = 0;
  double total_s() const { return at_s + before_s + after_s; }
};

/// Of each moment dt of exploring, dt (1 - v / v_max) is lost; v is the reference's speed. The parts sum up
/// to `total_s`.
struct LostTime {
  double explored_s = 0, total_s = 0, path_m = 0, max_speed_mps = 0;
  double look_around_s = 0;           // at the start, for vehicles whose cameras see one side
  double turning_s = 0;               // on the spot
  double waiting_s = 0;               // at rest, neither turning nor looking around
  double nearly_full_speed_s = 0;     // above 0.9 of v_max
  std::array<Slowdown, 4> slowdowns;  // by SlowdownCause
  Slowdown& operator[](SlowdownCause cause) { return slowdowns[static_cast<std::size_t>(cause)]; }
  const Slowdown& operator[](SlowdownCause cause) const { return slowdowns[static_cast<std::size_t>(cause)]; }
};

/// Until `until_s` of the run's time. Nothing if the run's telemetry lacks the reference, or its settings the
/// limits `motion.max_speed`, `motion.max_acceleration` and `motion.max_heading_rate`.
std::optional<LostTime> lost_time(const RunRecord& run,
                                  double until_s = std::numeric_limits<double>::infinity());

}  // namespace karst::evaluation
