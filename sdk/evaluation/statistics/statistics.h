// Statistics of paired differences: size, certainty, number of further pairs needed. Equations, choices and
// sources: docs/statistics.md. All of it is deterministic: equal input and seed, equal result.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace karst::evaluation {

/// Differences a - b of one figure between two contestants that flew the same cave with the same seed: one
/// vector per cave, one value per seed, all finite. Caves without a pair do not count.
using Differences = std::vector<std::vector<double>>;

struct Interval {
  double low, high;                                              // NaN if there are too few pairs
  bool excludes(double v) const { return low > v || high < v; }  // false if unknown
};

/// Mean over the caves of the mean over a cave's seeds: caves have equal weight, however many seeds they
/// have. NaN without pairs.
double mean_difference(const Differences& differences);

/// The unit that is resampled, which determines what an interval covers.
enum class Resampled {
  seeds,  // within each cave: other seeds in these caves; needs two pairs in every cave
  caves,  // whole caves: other caves like these; needs two caves
};
struct BootstrapOptions {
  double level = 0.95;
  int resamples = 4000;
  std::uint64_t seed = 1;
};
/// Interval of the mean difference: a percentile bootstrap, its quantiles widened for small samples.
Interval bootstrap_interval(const Differences& differences, Resampled unit,
                            const BootstrapOptions& options = {});

/// Wilcoxon's signed-rank test, two-sided; differences of zero are left out, equal ones get their mean
/// rank.
struct SignedRank {
  std::size_t zeros = 0, positive = 0, negative = 0;
  double rank_sum_positive = 0, rank_sum_negative = 0;
  double p = 1;        // 1 if all differences are zero
  bool exact = false;  // else normal approximation, corrected for ties and continuity
};
/// Exact for up to `max_exact` non-zero differences, at most 50.
SignedRank signed_rank(std::span<const double> differences, std::size_t max_exact = 50);
/// Over the pairs of all caves together.
SignedRank signed_rank(const Differences& differences, std::size_t max_exact = 50);

/// Matched-pairs rank-biserial correlation (W+ - W-) / (W+ + W-), from -1 (b always more) to 1; 0 if all
/// differences are zero.
double rank_biserial(const SignedRank& test);

/// The mean difference in units of the standard deviation within caves (Cohen's d_z); NaN if that is
/// unknown.
double standardized_difference(const Differences& differences);

/// Holm's corrected p-values in the given order: testing them against a limits the family-wise error rate to
/// a. NaN stays NaN and does not count as a test.
std::vector<double> holm(const std::vector<double>& p);

/// Total number of seeds per cave needed until a difference is shown.
struct Forecast {
  static constexpr int kNever = 1000;  // this many or more, or not foreseeable
  int seeds = kNever;                  // for power 0.8 at the observed spread
  int low = kNever, high = kNever;  // 80 % interval, from the uncertainty of the spread (and of the effect)
};
struct ForecastOptions {
  double alpha = 0.05;
  int tests = 1;  // number of tests that share alpha: the pairs of contestants
  double power = 0.8;
  int simulations = 1000;  // of a campaign, for every number of seeds tried
  std::uint64_t seed = 1;
};
/// Forecast if the true mean difference were `effect` and pairs had the observed spread: the pairs are
/// shifted to that mean, and campaigns drawn from them. Needs two pairs in every cave.
Forecast forecast_seeds(const Differences& differences, double effect, const ForecastOptions& options = {});
/// Forecast if the true mean difference were the observed one, which is itself uncertain.
Forecast forecast_seeds_as_observed(const Differences& differences, const ForecastOptions& options = {});

}  // namespace karst::evaluation
