// What paired differences show: how large, how sure, and how many more would be needed. Equations, choices
// and sources: docs/statistics.md. All of it is deterministic: equal input and seed, equal result.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace karst::evaluation {

/// Differences a - b of one figure between two contestants that flew the same cave with the same seed: a
/// vector a cave, a value a seed, all finite. Caves without a pair do not count.
using Differences = std::vector<std::vector<double>>;

struct Interval {
  double low, high;                                              // NaN where there are too few pairs to tell
  bool excludes(double v) const { return low > v || high < v; }  // false of an unknown one
};

/// Mean over the caves of the mean over a cave's seeds: caves weigh the same, however many seeds they have.
/// NaN without pairs.
double mean_difference(const Differences& differences);

/// What is drawn anew, and with it what an interval speaks for.
enum class Resampled {
  seeds,  // within each cave: other seeds in these caves; needs two pairs in every cave
  caves,  // whole caves: other caves like these; needs two caves
};
struct BootstrapOptions {
  double level = 0.95;
  int resamples = 4000;
  std::uint64_t seed = 1;
};
/// Of the mean difference: a percentile bootstrap with its quantiles widened for small samples.
Interval bootstrap_interval(const Differences& differences, Resampled unit,
                            const BootstrapOptions& options = {});

/// Wilcoxon's signed-rank test, two-sided; differences of zero are left out, equal ones share their mean
/// rank.
struct SignedRank {
  std::size_t zeros = 0, positive = 0, negative = 0;
  double rank_sum_positive = 0, rank_sum_negative = 0;
  double p = 1;        // 1 if all differences are zero
  bool exact = false;  // else normal approximation, corrected for ties and continuity
};
/// Exact for up to `max_exact` differences that are not zero, at most 50.
SignedRank signed_rank(std::span<const double> differences, std::size_t max_exact = 50);
/// Of all caves' pairs together.
SignedRank signed_rank(const Differences& differences, std::size_t max_exact = 50);

/// Matched-pairs rank-biserial correlation (W+ - W-) / (W+ + W-), from -1 (b always more) to 1; 0 without any
/// difference.
double rank_biserial(const SignedRank& test);

/// The mean difference in units of the standard deviation within caves (Cohen's d_z); NaN if that is not
/// known.
double standardized_difference(const Differences& differences);

/// Holm's corrected p-values in the order given: with them below a, at most a share a of all families of
/// tests without any difference calls one. NaN stays NaN and does not count as a test.
std::vector<double> holm(const std::vector<double>& p);

/// How many seeds a cave it takes, in all, until a difference is shown.
struct Forecast {
  static constexpr int kNever = 1000;  // this many or more, or not foreseeable
  int seeds = kNever;                  // power 0.8 at the spread observed
  int low = kNever, high = kNever;  // 80 % interval, for what is not known of the spread (and of the effect)
};
struct ForecastOptions {
  double alpha = 0.05;
  int tests = 1;  // that share alpha: the pairs of contestants
  double power = 0.8;
  int simulations = 1000;  // of a campaign, for every number of seeds tried
  std::uint64_t seed = 1;
};
/// If the true mean difference were `effect` and pairs spread as those observed: they are moved there, and
/// campaigns drawn from them. Needs two pairs in every cave.
Forecast forecast_seeds(const Differences& differences, double effect, const ForecastOptions& options = {});
/// If the true mean difference were the observed one, which is itself uncertain.
Forecast forecast_seeds_as_observed(const Differences& differences, const ForecastOptions& options = {});

}  // namespace karst::evaluation
