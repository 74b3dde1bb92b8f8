// Verdicts and figures for the page.
#include <algorithm>
#include <cmath>

#include "sdk/campaign/report/report_parts.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::campaign {
namespace {

using evaluation::Interval;
using nlohmann::ordered_json;

ordered_json pair_of(const Interval& i) { return {number_or_null(i.low), number_or_null(i.high)}; }

ordered_json comparison_row(const Comparison& c) {
  ordered_json row = {{"a", c.a},
                      {"b", c.b},
                      {"metric", c.metric},
                      {"pairs", c.pairs},
                      {"unpaired", c.unpaired},
                      {"unknown", c.unknown},
                      {"mean_a", number_or_null(c.mean_a)},
                      {"mean_b", number_or_null(c.mean_b)},
                      {"difference", number_or_null(c.difference)},
                      {"interval", pair_of(c.interval)},
                      {"interval_caves", pair_of(c.interval_caves)},
                      {"p", number_or_null(c.p_corrected)},
                      {"rank_biserial", number_or_null(c.rank_biserial)},
                      {"standardized", number_or_null(c.standardized)},
                      {"shown", core::name_of(c.shown)},
                      {"sentence", c.sentence}};
  for (const CaveComparison& cave : c.per_cave)
    row["caves"].push_back({{"cave", cave.cave},
                            {"pairs", cave.pairs},
                            {"difference", number_or_null(cave.difference)},
                            {"interval", pair_of(cave.interval)}});
  return row;
}

/// n, mean and interval over the caves that have values.
ordered_json summary(const evaluation::Differences& by_cave, const VerdictOptions& options,
                     const Interval& possible) {
  std::size_t n = 0;
  for (const auto& values : by_cave) n += values.size();
  if (n == 0) return nullptr;
  const MeanInterval of_mean = mean_interval(by_cave, options, options.resamples, possible);
  ordered_json row = {{"n", n},
                      {"mean", number_or_null(evaluation::mean_difference(by_cave))},
                      {"interval", pair_of(of_mean.interval)}};
  if (of_mean.over_caves) row["over"] = "caves";
  return row;
}

}  // namespace

MeanInterval mean_interval(const evaluation::Differences& values, const VerdictOptions& options,
                           int resamples, const Interval& possible) {
  const evaluation::BootstrapOptions bootstrap{
      .level = 1 - options.alpha, .resamples = resamples, .seed = options.seed};
  const Interval over_seeds = bootstrap_interval(values, evaluation::Resampled::seeds, bootstrap);
  const auto cut = [&](const Interval& i) {
    return Interval{std::max(i.low, possible.low), std::min(i.high, possible.high)};
  };
  if (!std::isnan(over_seeds.low)) return {cut(over_seeds), false};
  const Interval over_caves = bootstrap_interval(values, evaluation::Resampled::caves, bootstrap);
  const bool known = !std::isnan(over_caves.low);
  return {known ? cut(over_caves) : over_caves, known};
}

ordered_json report_verdicts(const Verdicts& verdicts) {
  ordered_json d = {{"metric", verdicts.metric}, {"sentence", verdicts.sentence}};
  d["ranking"] = ordered_json::array();
  for (const RankedContestant& p : verdicts.ranking)
    d["ranking"].push_back({{"contestant", p.contestant},
                            {"mean", number_or_null(p.mean)},
                            {"best", p.best},
                            {"worst", p.worst},
                            {"groups", p.groups}});
  d["comparisons"] = ordered_json::array();
  for (const Comparison& c : verdicts.comparisons) d["comparisons"].push_back(comparison_row(c));
  return d;
}

ordered_json report_summary(const CampaignResults& results, const VerdictOptions& options, int metric) {
  const evaluation::MetricDefinition& figure =
      evaluation::metric_definitions()[static_cast<std::size_t>(metric)];
  const Interval possible{figure.least, figure.most};
  std::vector<evaluation::Differences> values(results.contestants.size(),
                                              evaluation::Differences(results.caves.size()));
  for (const TrialResult& t : results.trials) {
    const double v = figure_of(t, metric, results.horizon_s);
    if (std::isfinite(v)) values[t.contestant][t.cave].push_back(v);
  }
  ordered_json row = ordered_json::array();
  for (const evaluation::Differences& by_cave : values) {
    ordered_json caves = ordered_json::array();
    for (const auto& one : by_cave) caves.push_back(summary({one}, options, possible));
    row.push_back({{"all", summary(by_cave, options, possible)}, {"caves", std::move(caves)}});
  }
  return row;
}

ordered_json report_summaries(const CampaignResults& results, const VerdictOptions& options) {
  ordered_json figures = ordered_json::array();
  for (int m = 0; m < static_cast<int>(evaluation::metric_definitions().size()); ++m)
    figures.push_back(report_summary(results, options, m));
  return figures;
}

}  // namespace karst::campaign
