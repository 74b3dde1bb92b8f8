#include "sdk/campaign/report/verdict_json.h"

#include "sdk/campaign/report/report_parts.h"
#include "sdk/campaign/verdict/figure_words.h"
#include "sdk/campaign/verdict/verdict.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::campaign {
namespace {

using nlohmann::ordered_json;

/// Who is shown to be better, or to have more; null if it is open.
ordered_json better_of(const CampaignResults& results, const Comparison& c) {
  switch (c.shown) {
    case Shown::a_better:
    case Shown::a_more:
      return results.contestants[c.a].name;
    case Shown::b_better:
    case Shown::b_more:
      return results.contestants[c.b].name;
    case Shown::no_difference:
      break;
  }
  return nullptr;
}

ordered_json pair_row(const CampaignResults& results, const Comparison& c) {
  return {{"a", results.contestants[c.a].name},
          {"b", results.contestants[c.b].name},
          {"pairs", c.pairs},
          {"mean_a", number_or_null(c.mean_a)},
          {"mean_b", number_or_null(c.mean_b)},
          {"difference", number_or_null(c.difference)},
          {"low", number_or_null(c.interval.low)},
          {"high", number_or_null(c.interval.high)},
          {"p", number_or_null(c.p_corrected)},
          {"rank_biserial", number_or_null(c.rank_biserial)},
          {"better", better_of(results, c)},
          {"sentence", c.sentence}};
}

ordered_json place_row(const CampaignResults& results, const RankedContestant& place,
                       const MeanInterval& mean) {
  std::size_t trials = 0, failed = 0;
  for (const TrialResult& t : results.trials) {
    if (t.contestant != place.contestant) continue;
    ++trials;
    failed += t.failed ? 1u : 0u;
  }
  return {{"contestant", results.contestants[place.contestant].name},
          {"best_place", place.best},
          {"worst_place", place.worst},
          {"groups", place.groups},
          {"trials", trials},
          {"failed", failed},
          {"mean", number_or_null(place.mean)},
          {"low", number_or_null(mean.interval.low)},
          {"high", number_or_null(mean.interval.high)}};
}

/// By contestant and figure.
ordered_json means_of(const CampaignResults& results) {
  ordered_json all;
  for (std::size_t m = 0; m < evaluation::metric_definitions().size(); ++m) {
    const std::vector<double> means = comparable_means(results, static_cast<int>(m));
    for (std::size_t c = 0; c < means.size(); ++c)
      all[results.contestants[c].name][std::string(evaluation::metric_definitions()[m].name)] =
          number_or_null(means[c]);
  }
  return all;
}

}  // namespace

ordered_json verdict_json(const CampaignResults& results, const std::string& metric) {
  if (results.trials.empty()) return nullptr;
  VerdictOptions options;
  options.metric = metric.empty() ? results.metric : metric;
  const Verdicts verdicts = compare_all(results, options);
  const evaluation::MetricDefinition& figure =
      evaluation::metric_definitions()[static_cast<std::size_t>(verdicts.metric)];
  const std::vector<evaluation::Differences> by_contestant = comparable_figures(results, verdicts.metric);
  ordered_json out{
      {"metric", options.metric},   {"declared", results.metric},         {"subject", subject_of(figure)},
      {"unit", figure.unit},        {"is_fraction", is_fraction(figure)}, {"sentence", verdicts.sentence},
      {"means", means_of(results)}, {"ranking", ordered_json::array()},   {"pairs", ordered_json::array()}};
  for (const RankedContestant& place : verdicts.ranking)
    out["ranking"].push_back(place_row(results, place,
                                       mean_interval(by_contestant[place.contestant], options,
                                                     options.resamples, {figure.least, figure.most})));
  for (const Comparison& c : verdicts.comparisons)
    if (c.metric == verdicts.metric) out["pairs"].push_back(pair_row(results, c));
  return out;
}

}  // namespace karst::campaign
