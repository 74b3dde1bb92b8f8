#include "sdk/tools/results_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/options.h"
#include "sdk/campaign/paper/restricted_time.h"
#include "sdk/campaign/verdict/figure_words.h"
#include "sdk/campaign/verdict/overview.h"
#include "sdk/campaign/verdict/verdict.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "sdk/terminal/terminal.h"

namespace karst::tools {
namespace {

using campaign::CampaignResults;

std::string number(double v) {
  if (!std::isfinite(v)) return "-";
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), std::abs(v) < 10 ? "%.3f" : "%.1f", v);
  return text.data();
}

struct Column {
  std::vector<double> means;    // by contestant
  std::vector<bool> unreached;  // a restricted time that no flight of the contestant reached
};
Column column_of(const CampaignResults& results, int metric) {
  Column column{campaign::comparable_means(results, metric),
                std::vector<bool>(results.contestants.size(), false)};
  if (!campaign::is_restricted_time(metric)) return column;
  const std::vector<campaign::Reached> reached = campaign::reached_by(results, metric);
  for (std::size_t i = 0; i < reached.size(); ++i) column.unreached[i] = reached[i].never();
  return column;
}

void print_row(const CampaignResults& results, const campaign::RankedContestant& place,
               const std::vector<Column>& columns) {
  int trials = 0, failed = 0;
  for (const campaign::TrialResult& t : results.trials)
    if (t.contestant == place.contestant) {
      ++trials;
      failed += t.failed;
    }
  const std::string best = std::to_string(place.best), worst = std::to_string(place.worst);
  std::string line = "| " + (best == worst ? best : best + "-" + worst) + " | " +
                     results.contestants[place.contestant].name + " | " + std::to_string(trials) + " | " +
                     std::to_string(failed) + " |";
  for (const Column& c : columns)
    line += (c.unreached[place.contestant] ? " > " : " ") + number(c.means[place.contestant]) + " |";
  print_out("%s\n", line.c_str());
}

constexpr std::size_t kFew = 3;  // contestants whose pairs are three sentences

void check_contestant(const CampaignResults& results, const std::string& name) {
  if (name.empty()) return;
  std::vector<std::string> names;
  for (const auto& c : results.contestants) names.push_back(c.name);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  const std::string near = core::nearest_name(name, names);
  throw core::InputError("--pairs-of", name,
                         near.empty() ? "no such contestant; they are " + campaign::listed(names)
                                      : "no such contestant; did you mean " + near + "?");
}

void print_overview(const CampaignResults& results, const campaign::Verdicts& verdicts) {
  const evaluation::MetricDefinition& figure =
      evaluation::metric_definitions()[static_cast<std::size_t>(verdicts.metric)];
  print_wrapped(stdout, 2, "%s\n\n", verdicts.sentence.c_str());
  print_out("%s, by place; contestants of one line are not told apart:\n",
            campaign::subject_of(figure).c_str());
  for (const std::string& line : campaign::ranking_lines(verdicts, results))
    print_out("  %s\n", line.c_str());
  print_out("\n%s\n", campaign::matrix_title(verdicts).c_str());
  for (const std::string& line : campaign::matrix_lines(verdicts, results)) print_out("  %s\n", line.c_str());
  print_out("\n");
}

}  // namespace

void check_metric(const std::string& metric) {
  if (evaluation::metric_index(metric) >= 0) return;
  std::vector<std::string> names;
  for (const evaluation::MetricDefinition& m : evaluation::metric_definitions()) names.emplace_back(m.name);
  const std::string near = core::nearest_name(metric, names);
  throw core::InputError("--metric", metric,
                         "no such figure" + (near.empty() ? "" : "; did you mean " + near + "?"));
}

void print_results(const CampaignResults& results, const std::string& asked, const PairSentences& pairs) {
  const std::string metric = asked.empty() ? results.metric : asked;
  check_metric(metric);
  check_contestant(results, pairs.of);
  if (metric != results.metric)
    print_out("The campaign declared %s before it flew; what follows is about %s.\n", results.metric.c_str(),
              metric.c_str());
  campaign::VerdictOptions options;
  options.metric = metric;
  const campaign::Verdicts verdicts = campaign::compare_all(results, options);
  const bool many = results.contestants.size() > kFew;
  if (many) print_overview(results, verdicts);
  std::vector<std::string> figures = {metric};
  for (const std::string_view f : campaign::headline_figures())
    if (f != metric) figures.emplace_back(f);
  std::string head = "| place | contestant | trials | failed |", rule = "|---:|---|---:|---:|";
  std::vector<Column> columns;
  bool unreached = false;
  for (const std::string& f : figures) {
    head += " " + f + " |";
    rule += "---:|";
    const Column& c = columns.emplace_back(column_of(results, evaluation::metric_index(f)));
    unreached = unreached || std::find(c.unreached.begin(), c.unreached.end(), true) != c.unreached.end();
  }
  print_out("%s: means over %s, of the flights that all have flown\n\n%s\n%s\n", results.name.c_str(),
            core::counted(results.caves.size(), "cave").c_str(), head.c_str(), rule.c_str());
  for (const campaign::RankedContestant& place : verdicts.ranking) print_row(results, place, columns);
  print_out("\n");
  if (unreached)
    print_out("> %.0f: no flight reached this coverage before the horizon of %.0f s.\n\n", results.horizon_s,
              results.horizon_s);
  const auto concerns = [&](const campaign::Comparison& c) {
    if (!pairs.of.empty())
      return results.contestants[c.a].name == pairs.of || results.contestants[c.b].name == pairs.of;
    return pairs.all || !many;
  };
  for (const campaign::Comparison& c : verdicts.comparisons)
    if (c.metric == verdicts.metric && concerns(c)) print_wrapped(stdout, 2, "%s\n", c.sentence.c_str());
  if (!many && results.contestants.size() > 2) print_wrapped(stdout, 2, "\n%s\n", verdicts.sentence.c_str());
  if (many && !pairs.all && pairs.of.empty())
    print_out(
        "With --pairs, karst results says each pair in a sentence; with --pairs-of NAME, those of one.\n");
}

}  // namespace karst::tools
