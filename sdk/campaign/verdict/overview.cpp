#include "sdk/campaign/verdict/overview.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/character_count.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/unit_text.h"
#include "sdk/campaign/verdict/figure_words.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::campaign {
namespace {

using core::format_text;

constexpr std::size_t kMostDifferences = 10;  // contestants; their matrix has some 100 columns
constexpr std::size_t kLongestName = 32;      // in the matrix

const evaluation::MetricDefinition& primary_figure(const Verdicts& verdicts) {
  return evaluation::metric_definitions()[static_cast<std::size_t>(verdicts.metric)];
}

/// As words have it: shares in percent.
double shown_value(const evaluation::MetricDefinition& figure, double v) {
  return is_fraction(figure) ? 100 * v : v;
}
std::string unit_after(const evaluation::MetricDefinition& figure) {
  if (is_fraction(figure)) return " %";
  return figure.unit.empty() ? "" : " " + core::unit_text(figure.unit);
}

/// Contestants of which no two are shown to differ, or, in the last line, the rest.
struct Line {
  std::string groups;  // as RankedContestant has them
  bool rest = false;
  int best = 0, worst = 0;
  std::vector<const RankedContestant*> members;
};

std::vector<Line> grouped(const std::vector<RankedContestant>& ranking, std::size_t most) {
  std::vector<Line> lines;
  for (const RankedContestant& place : ranking) {
    auto line = std::find_if(lines.begin(), lines.end(),
                             [&](const Line& l) { return !l.rest && l.groups == place.groups; });
    if (line == lines.end() && lines.size() < most) {
      line = lines.insert(lines.end(), {place.groups, false, place.best, place.worst, {}});
    } else if (line == lines.end()) {
      line = lines.end() - 1;
      line->rest = true;
    }
    line->best = std::min(line->best, place.best);
    line->worst = std::max(line->worst, place.worst);
    line->members.push_back(&place);
  }
  return lines;
}

/// `row` less `column`, and whether it is shown which of them is better.
struct Cell {
  double difference = 0;
  int shown = 0;  // 1: the row is better, or has more; -1: worse; 0: not shown
};
Cell cell_of(const Verdicts& verdicts, std::size_t row, std::size_t column) {
  const Comparison* c = verdicts.find(row, column, verdicts.metric);
  if (c == nullptr || c->pairs == 0) return {std::nan(""), 0};
  const double sign = c->a == row ? 1 : -1;
  if (c->shown == Shown::no_difference) return {sign * c->difference, 0};
  const bool a_first = c->shown == Shown::a_better || c->shown == Shown::a_more;
  return {sign * c->difference, (c->a == row) == a_first ? 1 : -1};
}

std::string difference_text(const Cell& cell, const evaluation::MetricDefinition& figure, int decimals) {
  if (std::isnan(cell.difference)) return "? ";
  const std::string number = fixed_text(shown_value(figure, cell.difference), decimals);
  return (number.starts_with('-') ? "" : "+") + number + (cell.shown == 0 ? " " : "*");
}

std::string cut(const std::string& name) {
  if (core::character_count(name) <= kLongestName) return name;
  return std::string(core::first_characters(name, kLongestName - 2)) + "..";
}

std::string padded(const std::string& text, std::size_t width) {
  const std::size_t has = core::character_count(text);
  return text + std::string(has < width ? width - has : 0, ' ');
}

}  // namespace

std::vector<std::string> ranking_lines(const Verdicts& verdicts, const CampaignResults& results,
                                       std::size_t most) {
  const evaluation::MetricDefinition& figure = primary_figure(verdicts);
  std::vector<std::string> lines;
  for (const Line& line : grouped(verdicts.ranking, most)) {
    std::vector<std::string> names;
    for (const RankedContestant* place : line.members)
      names.push_back(results.contestants[place->contestant].name +
                      (std::isnan(place->mean)
                           ? ""
                           : " " +
                                 fixed_text(shown_value(figure, place->mean),
                                            decimals_for(shown_value(figure, place->mean), 3)) +
                                 unit_after(figure)));
    const std::string places = line.best == line.worst
                                   ? std::to_string(line.best)
                                   : std::to_string(line.best) + "-" + std::to_string(line.worst);
    std::string text = padded(places, 6) + (line.rest ? "the rest: " : "");
    for (std::size_t i = 0; i < names.size(); ++i) text += (i == 0 ? "" : ", ") + names[i];
    lines.push_back(text);
  }
  return lines;
}

std::string matrix_title(const Verdicts& verdicts) {
  const evaluation::MetricDefinition& figure = primary_figure(verdicts);
  const std::vector<RankedContestant>& ranking = verdicts.ranking;
  bool gaps = false;
  for (const RankedContestant& a : ranking)
    for (const RankedContestant& b : ranking)
      gaps = gaps || (&a != &b && std::isnan(cell_of(verdicts, a.contestant, b.contestant).difference));
  const std::string missing = gaps ? "; ? no flights to compare" : "";
  if (ranking.size() > kMostDifferences) {
    const bool neutral = figure.better == evaluation::Better::neither;
    return std::string("Row against column: + shown ") +
           (neutral ? "more, - shown less" : "better, - shown worse") + ", . no difference shown" + missing;
  }
  const std::string unit = unit_after(figure);
  return "Differences" +
         (is_fraction(figure) ? " in points"
          : unit.empty()      ? ""
                              : " in" + unit) +
         ", row less column; * a difference is shown" + missing;
}

std::vector<std::string> matrix_lines(const Verdicts& verdicts, const CampaignResults& results) {
  const evaluation::MetricDefinition& figure = primary_figure(verdicts);
  const std::vector<RankedContestant>& ranking = verdicts.ranking;
  const bool differences = ranking.size() <= kMostDifferences;
  double scale = 0;  // of the largest difference: its digits are those of all
  std::size_t width = 0;
  for (const RankedContestant& a : ranking) {
    width = std::max(width, core::character_count(cut(results.contestants[a.contestant].name)));
    for (const RankedContestant& b : ranking)
      if (const Cell c = cell_of(verdicts, a.contestant, b.contestant); std::isfinite(c.difference))
        scale = std::max(scale, std::abs(shown_value(figure, c.difference)));
  }
  const int decimals = decimals_for(scale, 3), column = differences ? 8 : 4;
  std::string head = padded("", width + 4);
  for (std::size_t i = 0; i < ranking.size(); ++i)
    head += format_text("%*zu%s", column - 1, i + 1, differences ? " " : "");
  std::vector<std::string> lines{head};
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    std::string line =
        format_text("%2zu  ", i + 1) + padded(cut(results.contestants[ranking[i].contestant].name), width);
    for (std::size_t k = 0; k < ranking.size(); ++k) {
      const Cell cell = cell_of(verdicts, ranking[i].contestant, ranking[k].contestant);
      const std::string mark = std::isnan(cell.difference) ? "?"
                               : cell.shown > 0            ? "+"
                               : cell.shown < 0            ? "-"
                                                           : ".";
      line += differences ? format_text("%*s", column,
                                        i == k ? ". " : difference_text(cell, figure, decimals).c_str())
                          : format_text("%*s", column - 1, i == k ? "" : mark.c_str());
    }
    while (line.ends_with(' ')) line.pop_back();
    lines.push_back(line);
  }
  return lines;
}

}  // namespace karst::campaign
