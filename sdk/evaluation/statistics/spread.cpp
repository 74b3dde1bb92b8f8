#include "sdk/evaluation/statistics/spread.h"

#include <cmath>
#include <limits>

namespace karst::evaluation {

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double variance_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double sum = 0;
  for (const double v : values) sum += (v - mean) * (v - mean);
  return sum / static_cast<double>(values.size() - 1);
}

double mean_difference(const Differences& differences) {
  std::vector<double> means;
  for (const auto& cave : differences)
    if (!cave.empty()) means.push_back(mean_of(cave));
  return means.empty() ? std::numeric_limits<double>::quiet_NaN() : mean_of(means);
}

Spread spread_within_caves(const Differences& differences) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  Spread s{mean_difference(differences)};
  double caves = 0, fourth = 0;
  for (const auto& cave : differences) {
    if (cave.empty()) continue;
    if (cave.size() < 2) return {s.mean, kUnknown, kUnknown, kUnknown};
    const auto n = static_cast<double>(cave.size());
    const double of_mean = variance_of(cave) / n;
    s.variance += of_mean;
    s.plug_in += of_mean * (n - 1) / n;
    fourth += of_mean * of_mean / (n - 1);
    caves += 1;
  }
  if (caves == 0) return {kUnknown, kUnknown, kUnknown, kUnknown};
  s.degrees = fourth > 0 ? s.variance * s.variance / fourth : 0;
  s.variance /= caves * caves;
  s.plug_in /= caves * caves;
  return s;
}

double standardized_difference(const Differences& differences) {
  double sum = 0, degrees = 0;
  for (const auto& cave : differences) {
    if (cave.size() < 2) continue;
    sum += variance_of(cave) * static_cast<double>(cave.size() - 1);
    degrees += static_cast<double>(cave.size() - 1);
  }
  if (degrees == 0 || sum == 0) return std::numeric_limits<double>::quiet_NaN();
  return mean_difference(differences) / std::sqrt(sum / degrees);
}

}  // namespace karst::evaluation
