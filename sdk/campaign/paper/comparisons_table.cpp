#include <cmath>

#include "core_stack/common/counted.h"
#include "sdk/campaign/paper/printed_figure.h"
#include "sdk/campaign/paper/restricted_time.h"
#include "sdk/campaign/paper/result_tables.h"
#include "sdk/campaign/paper/table_text.h"
#include "sdk/campaign/verdict/figure_words.h"

namespace karst::campaign {
namespace {

using core::counted;
using evaluation::Interval;

std::string p_cell(double p) {
  if (!std::isfinite(p)) return "\u2013";
  return p < 0.001 ? "< 0.001" : fixed_text(p, 3);
}

/// Which of the pair is shown to be better, or to have more.
std::string shown_text(const Comparison& c, const CampaignResults& results) {
  if (c.shown == Shown::no_difference) return "\u2013";
  const bool a = c.shown == Shown::a_better || c.shown == Shown::a_more;
  return results.contestants[a ? c.a : c.b].name;
}

}  // namespace

PaperTable comparisons_table(const CampaignResults& results, const Verdicts& verdicts,
                             const VerdictOptions& options) {
  const PrintedFigure figure = printed_figure(verdicts.metric);
  std::vector<const Comparison*> primary;
  std::vector<Interval> intervals;
  std::vector<double> numbers;
  std::vector<std::size_t> pairs;
  bool over_caves = false;
  for (const Comparison& c : verdicts.comparisons) {
    if (c.metric != verdicts.metric) continue;
    primary.push_back(&c);
    intervals.push_back(c.interval);
    numbers.push_back(c.difference);
    pairs.push_back(c.pairs);
    over_caves = over_caves || (c.few_seeds && !std::isnan(c.interval.low));
  }
  PaperTable table{results.name + "-comparisons",
                   "",
                   {{"A", "", Aligned::left},
                    {"B", "", Aligned::left},
                    {"Pairs"},
                    {"Mean of A", figure.unit},
                    {"Mean of B", figure.unit},
                    {"A \u2212 B", figure.difference_unit},
                    {interval_heading(options), figure.difference_unit},
                    {"p"},
                    {"Rank-biserial correlation"},
                    {"Shown better", "", Aligned::left}},
                   {}};
  if (figure.better == evaluation::Better::neither) table.columns.back().heading = "Shown to have more";
  const int decimals = common_decimals(intervals, numbers, figure.factor);
  const auto number = [&](double v) { return printed_number(figure.factor * v, decimals); };
  bool never = false;
  const auto mean = [&](double v) {
    if (!is_restricted_time(verdicts.metric) || !is_horizon(v, results.horizon_s)) return number(v);
    never = true;
    return "> " + number(v);
  };
  for (const Comparison* c : primary) {
    const std::string shown = shown_text(*c, results), &a = results.contestants[c->a].name,
                      &b = results.contestants[c->b].name;
    table.rows.push_back({{a, a == shown},
                          {b, b == shown},
                          {std::to_string(c->pairs)},
                          {mean(c->mean_a)},
                          {mean(c->mean_b)},
                          {number(c->difference)},
                          {interval_text(c->interval, figure.factor, decimals,
                                         c->few_seeds ? DrawnFrom::caves : DrawnFrom::seeds)},
                          {p_cell(c->p_corrected)},
                          {printed_number(c->rank_biserial, 2)},
                          {shown}});
  }
  if (primary.empty()) return table;
  table.caption = "Pairs of contestants of campaign " + results.name + " in " + figure.subject + " (" +
                  options.metric + "): means over " + counted(results.caves.size(), "cave") +
                  " with equal weight, of " + range_text(pairs) + " pairs of flights. " +
                  bootstrap_text(options, over_caves) + ". Test: " + test_text(results, options) +
                  ". Bold: the contestant that is shown " +
                  (figure.better == evaluation::Better::neither ? "to have more." : "to be better.");
  if (is_restricted_time(verdicts.metric))
    table.caption += " " + restricted_text({verdicts.metric}, results.horizon_s) + "." +
                     (never ? " >: no flight reached it." : "");
  return table;
}

}  // namespace karst::campaign
