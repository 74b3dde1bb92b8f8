#include "sdk/tools/results_text.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/options.h"
#include "sdk/campaign/verdict/figure_words.h"
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

/// `means`: for each figure, each contestant's mean.
void print_row(const CampaignResults& results, const campaign::RankedContestant& place,
               const std::vector<std::vector<double>>& means) {
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
  for (const std::vector<double>& of_figure : means) line += " " + number(of_figure[place.contestant]) + " |";
  print_out("%s\n", line.c_str());
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

void print_results(const CampaignResults& results, const std::string& asked) {
  const std::string metric = asked.empty() ? results.metric : asked;
  check_metric(metric);
  if (metric != results.metric)
    print_out("The campaign declared %s before it flew; what follows is about %s.\n", results.metric.c_str(),
              metric.c_str());
  campaign::VerdictOptions options;
  options.metric = metric;
  const campaign::Verdicts verdicts = campaign::compare_all(results, options);
  std::vector<std::string> figures = {metric};
  for (const std::string_view f : campaign::headline_figures())
    if (f != metric) figures.emplace_back(f);
  std::string head = "| place | contestant | trials | failed |", rule = "|---:|---|---:|---:|";
  std::vector<std::vector<double>> means;
  for (const std::string& f : figures) {
    head += " " + f + " |";
    rule += "---:|";
    means.push_back(campaign::comparable_means(results, evaluation::metric_index(f)));
  }
  print_out("%s: means over %s, of the flights that all have flown\n\n%s\n%s\n", results.name.c_str(),
            core::counted(results.caves.size(), "cave").c_str(), head.c_str(), rule.c_str());
  for (const campaign::RankedContestant& place : verdicts.ranking) print_row(results, place, means);
  print_out("\n");
  for (const campaign::Comparison& c : verdicts.comparisons)
    if (c.metric == verdicts.metric) print_wrapped(stdout, 2, "%s\n", c.sentence.c_str());
  if (results.contestants.size() > 2) print_wrapped(stdout, 2, "\n%s\n", verdicts.sentence.c_str());
}

}  // namespace karst::tools
