// Number of seeds that a verdict needs: campaigns are simulated by drawing from the observed differences and
// judged like a real one. The mean is shifted to the effect in question; caves keep the part of their own
// effects that exceeds chance.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "core_stack/common/random.h"
#include "sdk/evaluation/statistics/quantiles.h"
#include "sdk/evaluation/statistics/spread.h"

namespace karst::evaluation {
namespace {

constexpr double kMaxSimulated = 25;  // approximate seeds per cave; larger numbers are scaled

/// The pool for simulated campaigns: with the mean at `effect`, and unbiased variances within and between
/// caves. None if a cave has a single pair.
std::optional<Differences> moved_to(const Differences& differences, double effect) {
  Differences pool;
  std::vector<double> means;
  double chance = 0;  // variance of the caves' means due to the seeds alone
  for (const auto& cave : differences) {
    if (cave.empty()) continue;
    if (cave.size() < 2) return std::nullopt;
    pool.push_back(cave);
    means.push_back(mean_of(cave));
    chance += variance_of(cave) / static_cast<double>(cave.size());
  }
  if (pool.empty()) return std::nullopt;
  chance /= static_cast<double>(pool.size());
  const double scatter = means.size() > 1 ? variance_of(means) : 0;
  const double own = scatter > chance ? std::sqrt((scatter - chance) / scatter) : 0;
  const double mean = mean_of(means);
  for (std::size_t c = 0; c < pool.size(); ++c) {
    const auto n = static_cast<double>(pool[c].size());
    for (double& d : pool[c]) d = effect + own * (means[c] - mean) + (d - means[c]) * std::sqrt(n / (n - 1));
  }
  return pool;
}

/// The verdict's rule (docs/statistics.md), with Student's interval instead of the bootstrap's.
bool is_shown(const Differences& campaign, double sign, const ForecastOptions& options) {
  constexpr std::size_t kMaxExact = 12;  // for more, the normal approximation is as good, and fast
  const Spread s = spread_within_caves(campaign);
  if (!(s.mean * sign > 0)) return false;
  const bool excludes_zero =
      s.variance == 0 ||
      std::abs(s.mean) > std::sqrt(s.variance) * student_t_quantile(1 - options.alpha / 2, s.degrees);
  return excludes_zero && signed_rank(campaign, kMaxExact).p < options.alpha / options.tests;
}

double power_of(int seeds, const Differences& pool, double sign, const ForecastOptions& options) {
  core::Random random = core::Random::stream(options.seed, "forecast " + std::to_string(seeds));
  Differences campaign(pool.size(), std::vector<double>(static_cast<std::size_t>(seeds)));
  int shown = 0;
  for (int i = 0; i < options.simulations; ++i) {
    for (std::size_t c = 0; c < pool.size(); ++c)
      for (double& d : campaign[c])
        d = pool[c][static_cast<std::size_t>(random.uniform() * static_cast<double>(pool[c].size()))];
    shown += is_shown(campaign, sign, options);
  }
  return static_cast<double>(shown) / options.simulations;
}

/// Seeds that a test of the mean alone would need, by the normal distribution: start of the search.
double first_guess(const Differences& pool, double effect, const ForecastOptions& options) {
  double variance = 0;
  for (const auto& cave : pool) variance += variance_of(cave);
  const double z = normal_quantile(1 - options.alpha / options.tests / 2) + normal_quantile(options.power);
  const auto caves = static_cast<double>(pool.size());
  return z * z * variance / (caves * caves * effect * effect);
}

int seeds_needed(const Differences& pool, double effect, double guess, const ForecastOptions& options) {
  const auto enough = [&](int n) { return power_of(n, pool, effect, options) >= options.power; };
  int low = 1, high = std::clamp(static_cast<int>(guess), 2, Forecast::kNever);  // one seed is never enough
  while (!enough(high)) {
    if (high == Forecast::kNever) return high;
    low = high;
    high = std::min(high + high / 4 + 1, Forecast::kNever);
  }
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (enough(middle) ? high : low) = middle;
  }
  return high;
}

int scaled(int seeds, double factor) {
  const double n = std::ceil(seeds * factor);
  return n < Forecast::kNever ? std::max(2, static_cast<int>(n)) : Forecast::kNever;
}

}  // namespace

Forecast forecast_seeds(const Differences& differences, double effect, const ForecastOptions& options) {
  auto pool = moved_to(differences, effect);
  if (!pool || !(std::abs(effect) > 0)) return {};
  Forecast f;
  const double guess = first_guess(*pool, effect, options);
  if (!(guess < 2.0 * Forecast::kNever)) return f;
  // Many pairs with a small effect equal fewer pairs with an effect larger by the square root of the ratio.
  const double fewer = std::max(1.0, guess / kMaxSimulated);
  const double larger_effect = effect * std::sqrt(fewer);
  pool = moved_to(differences, larger_effect);
  f.seeds = scaled(seeds_needed(*pool, larger_effect, guess / fewer, options), fewer);
  const double degrees = spread_within_caves(differences).degrees;
  if (degrees > 0 && f.seeds < Forecast::kNever) {  // the need scales with the variance, which is uncertain
    f.low = scaled(f.seeds, degrees / chi_squared_quantile(0.9, degrees));
    f.high = scaled(f.seeds, degrees / chi_squared_quantile(0.1, degrees));
  } else {
    f.low = f.high = f.seeds;
  }
  return f;
}

Forecast forecast_seeds_as_observed(const Differences& differences, const ForecastOptions& options) {
  const double effect = mean_difference(differences);
  Forecast f = forecast_seeds(differences, effect, options);
  const Interval likely =
      bootstrap_interval(differences, Resampled::seeds, {.level = 0.8, .seed = options.seed});
  if (std::isnan(likely.low) || !(std::abs(effect) > 0)) return {};
  // The need is proportional to 1 / effect^2; if the effect may be zero, no number of seeds is foreseeable.
  const double most = std::max(std::abs(likely.low), std::abs(likely.high)),
               least = std::min(std::abs(likely.low), std::abs(likely.high));
  f.low = scaled(f.seeds, effect * effect / (most * most));
  f.high = likely.excludes(0) ? scaled(f.seeds, effect * effect / (least * least)) : Forecast::kNever;
  return f;
}

}  // namespace karst::evaluation
