// Percentile bootstrap, widened: the variance of a resample of n pairs is too small by the factor (n - 1) /
// n, and its quantiles ignore the few degrees of freedom. Both are corrected by scaling the quantiles'
// distance from the mean by t / z * sqrt(variance / plug-in variance), which keeps the bootstrap's skewness.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core_stack/common/random.h"
#include "sdk/evaluation/statistics/quantiles.h"
#include "sdk/evaluation/statistics/spread.h"

namespace karst::evaluation {
namespace {

constexpr Interval kUnknown{std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::quiet_NaN()};

double resampled_mean(const Differences& differences, core::Random& random) {
  double sum = 0;
  for (const auto& cave : differences) {
    const auto n = static_cast<double>(cave.size());
    double of_cave = 0;
    for (std::size_t i = 0; i < cave.size(); ++i)
      of_cave += cave[static_cast<std::size_t>(random.uniform() * n)];
    sum += of_cave / n;
  }
  return sum / static_cast<double>(differences.size());
}

Interval stretched(const Differences& differences, const BootstrapOptions& options) {
  const Spread spread = spread_within_caves(differences);
  if (std::isnan(spread.variance)) return kUnknown;
  if (spread.variance == 0) return {spread.mean, spread.mean};
  core::Random random = core::Random::stream(options.seed, "bootstrap");
  std::vector<double> means(static_cast<std::size_t>(options.resamples));
  for (double& m : means) m = resampled_mean(differences, random);
  std::sort(means.begin(), means.end());
  const double tail = (1 - options.level) / 2;
  const auto from_end = static_cast<std::size_t>(tail * (options.resamples + 1));
  const std::size_t rank = std::max<std::size_t>(from_end, 1) - 1;
  const double stretch = student_t_quantile(1 - tail, spread.degrees) / normal_quantile(1 - tail) *
                         std::sqrt(spread.variance / spread.plug_in);
  return {spread.mean + (means[rank] - spread.mean) * stretch,
          spread.mean + (means[means.size() - 1 - rank] - spread.mean) * stretch};
}

}  // namespace

Interval bootstrap_interval(const Differences& differences, Resampled unit, const BootstrapOptions& options) {
  Differences flown;
  std::copy_if(differences.begin(), differences.end(), std::back_inserter(flown),
               [](const auto& cave) { return !cave.empty(); });
  if (unit == Resampled::seeds) return flown.empty() ? kUnknown : stretched(flown, options);
  std::vector<double> means;  // their scatter includes the scatter due to seeds
  for (const auto& cave : flown) means.push_back(mean_of(cave));
  return means.size() < 2 ? kUnknown : stretched({means}, options);
}

}  // namespace karst::evaluation
