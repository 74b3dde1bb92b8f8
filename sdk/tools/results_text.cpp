#include "sdk/tools/results_text.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"
#include "sdk/campaign/verdict.h"
#include "sdk/evaluation/metric_definitions.h"

namespace karst::tools {
namespace {

using campaign::CampaignResults;

constexpr std::array kColumns = {"coverage_auc",     "coverage",      "restricted_t50_s",
                                 "restricted_t90_s", "path_length_m", "contacts"};

/// Over the caves, of the mean over seeds: caves weigh the same.
double mean_of(const CampaignResults& results, std::size_t contestant, int metric) {
  std::vector<double> sum(results.caves.size()), count(results.caves.size());
  for (const campaign::TrialResult& t : results.trials) {
    const double v = t.contestant == contestant ? campaign::figure_of(t, metric, results.horizon_s) : NAN;
    if (std::isfinite(v)) sum[t.cave] += v, ++count[t.cave];
  }
  double all = 0, caves = 0;
  for (std::size_t c = 0; c < sum.size(); ++c)
    if (count[c] > 0) all += sum[c] / count[c], ++caves;
  return all / caves;  // NaN without any
}

std::string number(double v) {
  if (!std::isfinite(v)) return "-";
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), std::abs(v) < 10 ? "%.3f" : "%.1f", v);
  return text.data();
}

void print_row(const CampaignResults& results, const campaign::Place& place,
               const std::vector<std::string>& figures) {
  int trials = 0, failed = 0;
  for (const campaign::TrialResult& t : results.trials)
    if (t.contestant == place.contestant) ++trials, failed += t.failed;
  const std::string best = std::to_string(place.best), worst = std::to_string(place.worst);
  std::string line = "| " + (best == worst ? best : best + "-" + worst) + " | " +
                     results.contestants[place.contestant].name + " | " + std::to_string(trials) + " | " +
                     std::to_string(failed) + " |";
  for (const std::string& f : figures)
    line += " " + number(mean_of(results, place.contestant, evaluation::metric_index(f))) + " |";
  std::printf("%s\n", line.c_str());
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
    std::printf("The campaign declared %s before it flew; what follows is about %s.\n",
                results.metric.c_str(), metric.c_str());
  campaign::VerdictOptions options;
  options.metric = metric;
  const campaign::Verdicts verdicts = campaign::compare_all(results, options);
  std::vector<std::string> figures = {metric};
  for (const char* c : kColumns)
    if (c != metric) figures.emplace_back(c);
  std::string head = "| place | contestant | trials | failed |", rule = "|---:|---|---:|---:|";
  for (const std::string& f : figures) head += " " + f + " |", rule += "---:|";
  std::printf("%s: means over %zu cave%s\n\n%s\n%s\n", results.name.c_str(), results.caves.size(),
              results.caves.size() == 1 ? "" : "s", head.c_str(), rule.c_str());
  for (const campaign::Place& place : verdicts.ranking) print_row(results, place, figures);
  std::printf("\n");
  for (const campaign::Comparison& c : verdicts.comparisons)
    if (c.metric == verdicts.metric) std::printf("%s\n", c.sentence.c_str());
  if (results.contestants.size() > 2) std::printf("\n%s\n", verdicts.sentence.c_str());
}

}  // namespace karst::tools
