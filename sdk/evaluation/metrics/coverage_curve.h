// How the explored share of a cave grew, and the figures that sum the whole curve up.
#pragma once
#include <optional>
#include <vector>

#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

struct CoveragePoint {
  double time_s = 0;       // from take-off
  double explored_m3 = 0;  // known-free volume of the map
  double coverage = 0;     // NaN if it is not known
};

/// One point for each row of the telemetry from take-off on, the first at 0 s with what was known by then;
/// empty without telemetry. `final_coverage` is that of the final map. Only the free volume is recorded over
/// time; the part of it that lies in the reachable space is taken to grow in proportion, and is exact at the
/// end.
std::vector<CoveragePoint> coverage_curve(const RunRecord& run, std::optional<double> final_coverage);

/// From take-off; none if the curve never reaches the share, or is not known.
std::optional<double> time_of_coverage(const std::vector<CoveragePoint>& curve, double fraction);

/// What had been covered by `time_s` after take-off: the coverage of the last point no later.
std::optional<double> coverage_at(const std::vector<CoveragePoint>& curve, double time_s);

/// Mean over [0, horizon]: a coverage stands until the next, and the last one until the horizon.
std::optional<double> mean_coverage(const std::vector<CoveragePoint>& curve, double horizon_s);

/// The longest the flight could take: the mission's time limit, or the battery's hovering time if that is
/// shorter; none if the settings name neither.
std::optional<double> horizon_s(const RunRecord& run);

}  // namespace karst::evaluation
