// Coverage of a cave over time, and the figures that summarize the curve.
#pragma once
#include <optional>
#include <vector>

#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

struct CoveragePoint {
  double time_s = 0;       // from take-off
  double explored_m3 = 0;  // known-free volume of the map
  double coverage = 0;     // NaN if unknown
};

/// One point per telemetry row from take-off on, the first at 0 s with the value until then; empty
/// without telemetry. `final_coverage` is that of the final map. Only the free volume is recorded over
/// time; its part within the reachable space is assumed to grow in proportion, and is exact at the
/// end.
std::vector<CoveragePoint> coverage_curve(const RunRecord& run, std::optional<double> final_coverage);

/// From take-off; none if the curve never reaches the fraction, or coverage is unknown.
std::optional<double> time_of_coverage(const std::vector<CoveragePoint>& curve, double fraction);

/// The coverage at `time_s` after take-off: that of the last point no later.
std::optional<double> coverage_at(const std::vector<CoveragePoint>& curve, double time_s);

/// Mean over [0, horizon]: each coverage holds until the next point, and the last one until the horizon.
std::optional<double> mean_coverage(const std::vector<CoveragePoint>& curve, double horizon_s);

/// The longest possible flight: the mission's time limit, or the battery's hovering time if that is shorter;
/// none if the settings contain neither.
std::optional<double> horizon_s(const RunRecord& run);

}  // namespace karst::evaluation
