#include "sdk/campaign/verdict/verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core_stack/common/error.h"
#include "sdk/campaign/verdict/verdict_parts.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::campaign {
namespace {

using namespace evaluation;

/// Trials of each contestant, by cave and seed.
std::vector<std::vector<const TrialResult*>> trials_by_contestant(const CampaignResults& results) {
  const auto key = [](const TrialResult* t) { return std::pair(t->cave, t->seed); };
  std::vector<std::vector<const TrialResult*>> of(results.contestants.size());
  for (const TrialResult& t : results.trials) {
    if (t.contestant >= of.size() || t.cave >= results.caves.size() ||
        t.figures.size() != metric_definitions().size())
      throw core::InputError(results.name, "trial " + std::to_string(&t - results.trials.data()),
                             "does not name a contestant and a cave of the campaign, or holds other figures");
    of[t.contestant].push_back(&t);
  }
  for (auto& trials : of) {
    std::sort(trials.begin(), trials.end(), [&](auto* a, auto* b) { return key(a) < key(b); });
    const auto twice =
        std::adjacent_find(trials.begin(), trials.end(), [&](auto* a, auto* b) { return key(a) == key(b); });
    if (twice != trials.end())
      throw core::InputError(results.name, "seed " + std::to_string((*twice)->seed),
                             results.contestants[(*twice)->contestant].name + " flew it twice in " +
                                 results.caves[(*twice)->cave].name);
  }
  return of;
}

void measure(Comparison& c, const VerdictOptions& options) {
  const Differences differences = differences_of(c);
  const BootstrapOptions bootstrap{1 - options.alpha, options.resamples, options.seed};
  c.difference = mean_difference(differences);
  c.interval = bootstrap_interval(differences, Resampled::seeds, bootstrap);
  c.interval_caves = bootstrap_interval(differences, Resampled::caves, bootstrap);
  c.few_seeds = std::any_of(differences.begin(), differences.end(), [](auto& d) { return d.size() < 2; });
  if (c.few_seeds) c.interval = c.interval_caves;
  c.test = signed_rank(differences);
  c.rank_biserial = rank_biserial(c.test);
  c.standardized = standardized_difference(differences);
  for (std::size_t i = 0; i < differences.size(); ++i)
    c.per_cave[i].interval = bootstrap_interval({differences[i]}, Resampled::seeds, bootstrap);
}

/// Shown: the interval excludes zero, and the corrected p-value is below alpha (docs/statistics.md).
Shown judge(const Comparison& c, double alpha) {
  if (!(c.p_corrected < alpha) || !c.interval.excludes(0)) return Shown::no_difference;
  const Better better = metric_definitions()[static_cast<std::size_t>(c.metric)].better;
  if (better == Better::neither) return c.difference > 0 ? Shown::a_more : Shown::b_more;
  return (c.difference > 0) == (better == Better::more) ? Shown::a_better : Shown::b_better;
}

void forecast(Comparison& c, const VerdictOptions& options, std::size_t tests) {
  const Differences differences = differences_of(c);
  ForecastOptions forecast;
  forecast.alpha = options.alpha;
  forecast.tests = static_cast<int>(tests);
  forecast.simulations = options.simulations;
  forecast.seed = options.seed;
  c.worthwhile = options.worthwhile * std::abs(c.mean_a + c.mean_b) / 2;
  if (options.simulations == 0) return;
  c.forecast_worthwhile = forecast_seeds(differences, c.worthwhile, forecast);
  c.forecast_observed = forecast_seeds_as_observed(differences, forecast);
}

}  // namespace

std::size_t min_pairs(std::size_t contestants, double alpha) {
  if (contestants < 2) return 0;
  const double comparisons = static_cast<double>(contestants) * static_cast<double>(contestants - 1) / 2;
  // n pairs that all favour one side have p = 2 / 2^n; Holm multiplies the least p by all comparisons.
  int pairs = 1;
  while (std::ldexp(comparisons, 1 - pairs) >= alpha) ++pairs;
  return static_cast<std::size_t>(pairs);
}

double figure_of(const TrialResult& trial, int metric, double horizon_s) {
  const MetricDefinition& d = metric_definitions()[static_cast<std::size_t>(metric)];
  if (trial.failed && d.name == "completed") return 0;
  const double figure = trial.figures[static_cast<std::size_t>(metric)];
  if (std::isfinite(figure)) return figure;
  if (trial.failed && d.if_failed == IfFailed::nothing) return 0;
  if (trial.failed && d.if_failed == IfFailed::horizon) return horizon_s;
  return std::numeric_limits<double>::quiet_NaN();
}

const Comparison* Verdicts::find(std::size_t a, std::size_t b, int of_metric) const {
  const auto found = std::find_if(comparisons.begin(), comparisons.end(), [&](const Comparison& c) {
    return c.metric == of_metric && c.a == std::min(a, b) && c.b == std::max(a, b);
  });
  return found == comparisons.end() ? nullptr : &*found;
}

Verdicts compare_all(const CampaignResults& results, const VerdictOptions& options) {
  Verdicts verdicts;
  verdicts.metric = metric_index(options.metric);
  if (verdicts.metric < 0)
    throw core::InputError("verdict", "metric", "there is no figure called " + options.metric);
  const auto trials = trials_by_contestant(results);
  for (int metric = 0; metric < static_cast<int>(metric_definitions().size()); ++metric) {
    const std::size_t first = verdicts.comparisons.size();
    for (std::size_t a = 0; a < trials.size(); ++a)
      for (std::size_t b = a + 1; b < trials.size(); ++b) {
        Comparison& c = verdicts.comparisons.emplace_back();
        c.a = a;
        c.b = b;
        c.metric = metric;
        pair_trials(trials[a], trials[b], results.horizon_s, c);
        measure(c, options);
      }
    std::vector<double> p;
    for (std::size_t i = first; i < verdicts.comparisons.size(); ++i)
      p.push_back(verdicts.comparisons[i].pairs > 0 ? verdicts.comparisons[i].test.p
                                                    : std::numeric_limits<double>::quiet_NaN());
    const std::vector<double> corrected = holm(p);
    for (std::size_t i = first; i < verdicts.comparisons.size(); ++i) {
      Comparison& c = verdicts.comparisons[i];
      c.p_corrected = corrected[i - first];
      c.shown = judge(c, options.alpha);
      if (metric == verdicts.metric) forecast(c, options, p.size());
      c.sentence = sentence_of(c, results, options);
    }
  }
  verdicts.ranking = rank_contestants(verdicts, results);
  verdicts.sentence = sentence_of(verdicts, results);
  return verdicts;
}

}  // namespace karst::campaign
