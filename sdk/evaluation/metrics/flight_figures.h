// Figures of the flight itself: times, speeds, clearances and errors, from the run's record.
#pragma once
#include <optional>

#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

/// Empty where the record lacks the data. Definitions: docs/metrics.md.
struct FlightFigures {
  std::optional<std::int64_t> contacts;
  std::optional<double> flight_time_s, exploration_time_s, path_length_m, mean_speed_mps;
  std::optional<double> exploring_speed_mps, standing_share, longest_stall_s;
  std::optional<double> min_clearance_m, landing_error_m, battery_left;
  std::optional<double> energy_wh, depth_m, vertical_reach_m;
  std::optional<double> drift_percent, heading_error_rad, tracking_rms_m;
};

FlightFigures flight_figures(const RunRecord& run);

constexpr double kAtStart_m = 1;  // the mission's own bound for a landing at the start

/// Horizontal distance from the first true position to the last; none without ground truth.
std::optional<double> landed_off_m(const RunRecord& run);

/// Whether exploration ended because nothing was left, because of time or battery, or by the policy's
/// decision, not because the supervisor sent the vehicle home or made it land.
bool explored_to_its_end(const RunRecord& run);

/// Whether the mission succeeded: the outcome is landed, truly at the start (within kAtStart_m; without
/// ground truth by the vehicle's own estimate), and it explored to its end.
bool completed(const RunRecord& run, std::optional<double> landing_error_m);

/// Time of take-off: the begin of the first phase after standby, or the first telemetry row.
double flight_begin_s(const RunRecord& run);

/// The last finite value of a column; none if there is no such column or value.
std::optional<double> last_finite(const std::vector<double>* column);

}  // namespace karst::evaluation
