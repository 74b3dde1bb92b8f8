#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core_stack/common/counted.h"
#include "sdk/campaign/paper/printed_figure.h"
#include "sdk/campaign/paper/restricted_time.h"
#include "sdk/campaign/paper/result_tables.h"
#include "sdk/campaign/paper/table_text.h"
#include "sdk/campaign/report/report_parts.h"
#include "sdk/campaign/verdict/figure_words.h"

namespace karst::campaign {
namespace {

using core::counted;
using evaluation::Interval;

constexpr const char* kBySome = " \u2021";

/// Means of a figure as cells, in the order of the ranking. Bold: the one that is the best as printed.
std::vector<PaperCell> mean_cells(const PrintedFigure& figure, const std::vector<double>& means,
                                  int decimals) {
  std::vector<PaperCell> cells;
  double best = std::numeric_limits<double>::quiet_NaN();
  for (const double v : means) {
    cells.push_back({printed_number(figure.factor * v, decimals)});
    if (!std::isfinite(v)) continue;
    best = figure.better == evaluation::Better::less ? std::fmin(best, v) : std::fmax(best, v);
  }
  if (figure.better == evaluation::Better::neither || means.size() < 2 || !std::isfinite(best)) return cells;
  const std::string text = printed_number(figure.factor * best, decimals);
  const auto is_best = [&](const PaperCell& c) { return c.text == text; };
  if (std::count_if(cells.begin(), cells.end(), is_best) == 1)
    std::find_if(cells.begin(), cells.end(), is_best)->bold = true;
  return cells;
}

/// Marks means of restricted times behind which flights are that did not reach the coverage.
void mark_restricted(std::vector<PaperCell>& cells, const std::vector<std::size_t>& order,
                     const std::vector<Reached>& by_contestant) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Reached& r = by_contestant[order[i]];
    if (r.never()) cells[i] = {"> " + cells[i].text};
    if (r.by_some()) cells[i].text += kBySome;
  }
}

/// What the caption says of the columns with restricted times; "" without any.
std::string restricted_caption(const CampaignResults& results, const std::vector<int>& metrics,
                               const std::vector<std::size_t>& order) {
  std::vector<int> restricted;
  std::string never, by_some;
  for (const int metric : metrics) {
    if (!is_restricted_time(metric)) continue;
    restricted.push_back(metric);
    const std::vector<Reached> reached = reached_by(results, metric);
    if (std::any_of(reached.begin(), reached.end(), [](const Reached& r) { return r.never(); }))
      never = " >: no flight reached it.";
    if (const std::string some = reached_by_some_text(results, order, reached); !some.empty())
      by_some += (by_some.empty() ? " \u2021: only some flights reached it (" : "; ") +
                 printed_figure(metric).subject + ": " + some;
  }
  if (restricted.empty()) return "";
  return " " + restricted_text(restricted, results.horizon_s) + "." + never +
         (by_some.empty() ? "" : by_some + ").");
}

std::vector<double> ranked(const Verdicts& verdicts, const std::vector<double>& by_contestant) {
  std::vector<double> in_order;
  for (const RankedContestant& place : verdicts.ranking) in_order.push_back(by_contestant[place.contestant]);
  return in_order;
}

void add_column(PaperTable& table, PaperColumn column, const std::vector<PaperCell>& cells) {
  table.columns.push_back(std::move(column));
  for (std::size_t i = 0; i < cells.size(); ++i) table.rows[i].push_back(cells[i]);
}

struct FlownBy {
  std::size_t flights = 0, failed = 0;
};
FlownBy flown_by(const CampaignResults& results, std::size_t contestant) {
  FlownBy flown;
  for (const TrialResult& t : results.trials) {
    if (t.contestant != contestant) continue;
    ++flown.flights;
    flown.failed += t.failed;
  }
  return flown;
}

std::string ranking_caption(const CampaignResults& results, const PrintedFigure& figure,
                            const VerdictOptions& options, const std::vector<std::size_t>& flights,
                            bool any_over_caves) {
  std::string text = "Contestants of campaign " + results.name + " by " + figure.subject + " (" +
                     options.metric + "): means over " + counted(results.caves.size(), "cave") +
                     " with equal weight, of " + range_text(flights) + " flights of each contestant. " +
                     bootstrap_text(options, any_over_caves) + ".";
  if (results.contestants.size() < 2) return text;
  return text + " Contestants that share a letter are not shown to differ (" + test_text(results, options) +
         "). Bold: the best mean of a column, if one contestant alone has it.";
}

}  // namespace

PaperTable ranking_table(const CampaignResults& results, const Verdicts& verdicts,
                         const VerdictOptions& options) {
  const auto& definition = evaluation::metric_definitions()[static_cast<std::size_t>(verdicts.metric)];
  const PrintedFigure figure = printed_figure(verdicts.metric);
  const auto values = comparable_figures(results, verdicts.metric);
  std::vector<PaperCell> places, names, letters, flights, failed;
  std::vector<MeanInterval> means;
  std::vector<Interval> intervals;
  std::vector<std::size_t> counts;
  for (const RankedContestant& p : verdicts.ranking) {
    const std::string best = std::to_string(p.best), worst = std::to_string(p.worst);
    const FlownBy flown = flown_by(results, p.contestant);
    places.push_back({best == worst ? best : best + "\u2013" + worst});
    names.push_back({results.contestants[p.contestant].name});
    letters.push_back({p.groups});
    flights.push_back({std::to_string(flown.flights)});
    failed.push_back({std::to_string(flown.failed)});
    means.push_back(
        mean_interval(values[p.contestant], options, options.resamples, {definition.least, definition.most}));
    intervals.push_back(means.back().interval);
    std::size_t count = 0;
    for (const auto& cave : values[p.contestant]) count += cave.size();
    counts.push_back(count);
  }

  const std::vector<double> primary = ranked(verdicts, comparable_means(results, verdicts.metric));
  const int decimals = common_decimals(intervals, primary, figure.factor);
  std::vector<PaperCell> interval_cells;
  for (const MeanInterval& m : means)
    interval_cells.push_back({interval_text(m.interval, figure.factor, decimals,
                                            m.over_caves ? DrawnFrom::caves : DrawnFrom::seeds)});
  const bool over_caves = std::any_of(means.begin(), means.end(), [](auto& m) { return m.over_caves; });

  PaperTable table{results.name + "-ranking",
                   ranking_caption(results, figure, options, counts, over_caves),
                   {},
                   std::vector<std::vector<PaperCell>>(verdicts.ranking.size())};
  add_column(table, {"Place"}, places);
  add_column(table, {"Contestant", "", Aligned::left}, names);
  add_column(table, {"Group", "", Aligned::left}, letters);
  add_column(table, {"Flights"}, flights);
  add_column(table, {"Failed"}, failed);
  std::vector<std::size_t> order;
  for (const RankedContestant& p : verdicts.ranking) order.push_back(p.contestant);
  std::vector<int> metrics;
  const auto add_means = [&](int metric, const PrintedFigure& of, std::vector<PaperCell> cells) {
    if (is_restricted_time(metric)) mark_restricted(cells, order, reached_by(results, metric));
    add_column(table, {of.heading, of.unit}, cells);
    metrics.push_back(metric);
  };
  add_means(verdicts.metric, figure, mean_cells(figure, primary, decimals));
  add_column(table, {interval_heading(options), figure.unit}, interval_cells);
  for (const std::string_view name : headline_figures()) {
    const int metric = evaluation::metric_index(name);
    if (metric == verdicts.metric) continue;
    const PrintedFigure other = printed_figure(metric);
    const std::vector<double> others = ranked(verdicts, comparable_means(results, metric));
    add_means(metric, other, mean_cells(other, others, common_decimals({}, others, other.factor)));
  }
  table.caption += restricted_caption(results, metrics, order);
  return table;
}

}  // namespace karst::campaign
