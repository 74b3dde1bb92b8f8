// Evaluates a campaign's results: comparisons of every pair of contestants in every figure, the verdict in
// one sentence, and a ranking. docs/statistics.md
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core_stack/common/enum_names.h"
#include "sdk/campaign/store/results.h"
#include "sdk/evaluation/statistics/statistics.h"

namespace karst::campaign {

struct VerdictOptions {
  std::string metric = "coverage_auc";  // the primary figure, declared before the campaign; ranks contestants
  double alpha = 0.05;                  // probability of declaring a difference where there is none
  double worthwhile = 0.05;  // smallest relevant difference, as a fraction of the contestants' mean
  int resamples = 4000;
  int simulations = 1000;  // of campaigns, for a forecast; 0: no forecast
  std::uint64_t seed = 1;
};

/// The result of a comparison; "more" is used for a figure without a better direction.
enum class Shown { a_better, b_better, a_more, b_more, no_difference };
constexpr auto names_of(Shown) {
  using enum Shown;
  return std::to_array<core::Named<Shown>>({{a_better, "a better"},
                                            {b_better, "b better"},
                                            {a_more, "a more"},
                                            {b_more, "b more"},
                                            {no_difference, ""}});
}

/// A pair of contestants in one figure and one cave.
struct CaveComparison {
  std::size_t cave = 0;
  std::size_t pairs = 0;
  double mean_a = 0, mean_b = 0, difference = 0;  // a - b; NaN without pairs
  evaluation::Interval interval{};                // over seeds
};

/// A pair of contestants in one figure. Caves have equal weight.
struct Comparison {
  std::size_t a = 0, b = 0;  // contestants
  int metric = -1;           // evaluation::metric_definitions()[metric]
  std::size_t caves = 0, pairs = 0;
  std::size_t unpaired = 0;                       // trials whose partner has not flown
  std::size_t unknown = 0;                        // pairs left out: the figure of one of them is unknown
  std::size_t failed_a = 0, failed_b = 0;         // number of failed trials among all of them
  double mean_a = 0, mean_b = 0, difference = 0;  // a - b, in the figure's unit
  evaluation::Interval interval{};                // of level 1 - alpha, over seeds: for these caves
  evaluation::Interval interval_caves{};          // over caves: for caves like these
  bool few_seeds = false;  // a cave has a single pair: `interval` is then the one over caves
  evaluation::SignedRank test;
  double p_corrected = 1;  // Holm correction over all pairs of contestants in this figure
  double rank_biserial = 0, standardized = 0;
  Shown shown = Shown::no_difference;
  // Only for the primary figure: total number of seeds per cave needed to show the smallest relevant
  // difference, and to show a difference as large as the observed one.
  double worthwhile = 0;  // the smallest relevant difference, in the figure's unit
  evaluation::Forecast forecast_worthwhile, forecast_observed;
  std::vector<double> pair_a, pair_b;    // the pairs, by cave and seed; for scatter plots
  std::vector<std::size_t> pair_cave;    // cave of each
  std::vector<std::int64_t> pair_seed;   // seed of each
  std::vector<CaveComparison> per_cave;  // caves with pairs, in the campaign's order
  std::string sentence;                  // the verdict with its uncertainty
};

/// A contestant's rank by the primary figure.
struct RankedContestant {
  std::size_t contestant = 0;
  double mean = 0;  // over caves of the mean over seeds, of what all contestants flew; NaN without trials
  int best = 1, worst = 1;  // possible ranks: 1 + contestants shown better ... all less those shown worse
  std::string groups;       // letters: contestants with a common letter are not shown to differ
};

struct Verdicts {
  int metric = -1;                        // the primary one
  std::vector<Comparison> comparisons;    // by metric in the table's order, then a < b
  std::vector<RankedContestant> ranking;  // by the primary figure, best first
  std::string sentence;                   // the verdict of the campaign

  /// Null if there is none: a == b, or no such metric.
  const Comparison* find(std::size_t a, std::size_t b, int metric) const;
};

/// Least number of pairs of flights between two of so many contestants for which a difference can be shown at
/// all: with fewer, even pairs that all favour one side have a corrected p-value above `alpha` in the
/// signed-rank test. 0 for a single contestant.
std::size_t min_pairs(std::size_t contestants, double alpha);

/// Throws InputError if the metric is unknown, a trial occurs twice, or a trial lacks a value for a figure.
Verdicts compare_all(const CampaignResults& results, const VerdictOptions& options = {});

/// Each contestant's values by cave, restricted to the caves and seeds that all of them flew, so that caves
/// flown by some only do not affect the comparison; all its own values if there are none in common.
std::vector<evaluation::Differences> comparable_figures(const CampaignResults& results, int metric);
/// Means of these over caves, with equal weight. NaN if nothing is known.
std::vector<double> comparable_means(const CampaignResults& results, int metric);

/// The value of a trial in a figure; a failed trial gets a value instead of a gap where one can be defined
/// (docs/statistics.md).
double figure_of(const TrialResult& trial, int metric, double horizon_s);

}  // namespace karst::campaign
