#include "sdk/evaluation/metrics/coverage_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sdk/evaluation/metrics/flight_figures.h"

namespace karst::evaluation {

std::vector<CoveragePoint> coverage_curve(const RunRecord& run, std::optional<double> final_coverage) {
  const auto* t_s = run.telemetry.times();
  const auto* explored = run.telemetry.column("explored_m3");
  const auto final_m3 = last_finite(explored);
  if (!t_s || !final_m3) return {};
  const double fraction_per_m3 = final_coverage && *final_m3 > 0 ? *final_coverage / *final_m3
                                 : final_coverage                ? 0.0
                                                                 : std::numeric_limits<double>::quiet_NaN();
  const double begin_s = flight_begin_s(run);
  std::vector<CoveragePoint> curve{{0, 0, 0 * fraction_per_m3}};
  for (std::size_t i = 0; i < t_s->size(); ++i) {
    const double m3 = (*explored)[i];
    if (!std::isfinite((*t_s)[i]) || !std::isfinite(m3)) continue;
    // Free cells may later turn into rock: the known-free volume can then be smaller at the end than before.
    const double fraction =
        std::isnan(fraction_per_m3) ? fraction_per_m3 : std::min(1.0, m3 * fraction_per_m3);
    const CoveragePoint p{std::max(0.0, (*t_s)[i] - begin_s), m3, fraction};
    if (p.time_s > 0) {
      curve.push_back(p);
    } else {
      curve.front() = p;  // before take-off the vehicle observes from the ground
    }
  }
  return curve;
}

std::optional<double> time_of_coverage(const std::vector<CoveragePoint>& curve, double fraction) {
  for (const CoveragePoint& p : curve)
    if (p.coverage >= fraction) return p.time_s;
  return std::nullopt;
}

std::optional<double> coverage_at(const std::vector<CoveragePoint>& curve, double time_s) {
  if (curve.empty() || std::isnan(curve.back().coverage)) return std::nullopt;
  double covered = 0;
  for (const CoveragePoint& p : curve)
    if (p.time_s <= time_s) covered = p.coverage;
  return covered;
}

std::optional<double> mean_coverage(const std::vector<CoveragePoint>& curve, double horizon_s) {
  if (curve.empty() || !(horizon_s > 0) || std::isnan(curve.back().coverage)) return std::nullopt;
  double area = 0;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double until_s = i + 1 < curve.size() ? curve[i + 1].time_s : horizon_s;
    area += curve[i].coverage * std::max(0.0, std::min(until_s, horizon_s) - curve[i].time_s);
  }
  return area / horizon_s;
}

std::optional<double> horizon_s(const RunRecord& run) {
  const auto limit_s = run.number("mission.max_flight_time");
  const auto battery_min = run.number("simulator.battery_minutes");
  if (!limit_s && !battery_min) return std::nullopt;
  return std::min(limit_s.value_or(std::numeric_limits<double>::infinity()),
                  battery_min ? *battery_min * 60 : std::numeric_limits<double>::infinity());
}

}  // namespace karst::evaluation
