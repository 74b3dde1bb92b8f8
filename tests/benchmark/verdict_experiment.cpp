// What the verdict says where the truth is known: campaigns drawn from flights that were really flown.
//   verdict_experiment STORE|RUN... [--metric coverage_auc]
// For each contestant that flew a cave at least twice, campaigns are drawn whose pairs are two different
// flights of it in one cave: against itself; against itself with its figure made 5 % better; and crippled by
// 20 %.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "core_stack/common/random.h"
#include "sdk/campaign/store/store.h"
#include "sdk/campaign/verdict/verdict.h"
#include "sdk/evaluation/metrics/coverage_curve.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace {

using namespace karst;
using campaign::CampaignResults;

using Figures =
    std::vector<std::vector<double>>;  // one figure of one contestant: a vector a cave, a value a flight

template <class Entry>
std::size_t index_of(std::vector<Entry>& entries, const std::string& name) {
  const auto found = std::find_if(entries.begin(), entries.end(), [&](auto& e) { return e.name == name; });
  if (found != entries.end()) return static_cast<std::size_t>(found - entries.begin());
  entries.emplace_back().name = name;
  return entries.size() - 1;
}

/// Finished run directories as a campaign: figures from metrics.json, those of the coverage curve anew.
CampaignResults read_runs(const std::vector<std::string>& runs) {
  CampaignResults results;
  for (const std::string& dir : runs) {
    std::ifstream in(dir + "/metrics.json");
    const auto m = nlohmann::json::parse(in, nullptr, false);
    if (!m.is_object()) continue;
    const auto run = evaluation::read_run(dir);
    campaign::TrialResult t;
    t.contestant = index_of(results.contestants, m.at("policy"));
    t.cave = index_of(results.caves, m.at("cave"));
    t.seed = m.at("seed");
    t.figures.assign(evaluation::metric_definitions().size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < t.figures.size(); ++i)
      if (const auto v = m.find(evaluation::metric_definitions()[i].name); v != m.end() && v->is_number())
        t.figures[i] = *v;
    const double horizon = evaluation::horizon_s(run).value_or(390);
    results.horizon_s = std::max(results.horizon_s, horizon);
    const auto curve = evaluation::coverage_curve(
        run, m.at("coverage").is_number() ? std::optional(m.at("coverage").get<double>()) : std::nullopt);
    const auto set = [&](const char* name, std::optional<double> v) {
      if (v) t.figures[static_cast<std::size_t>(evaluation::metric_index(name))] = *v;
    };
    set("coverage_auc", evaluation::mean_coverage(curve, horizon));
    set("restricted_t90_s", std::min(evaluation::time_of_coverage(curve, 0.9).value_or(horizon), horizon));
    results.trials.push_back(t);
  }
  return results;
}

Figures figures_of(const CampaignResults& results, std::size_t contestant, int metric) {
  std::map<std::size_t, std::vector<double>> by_cave;
  for (const auto& t : results.trials)
    if (t.contestant == contestant)
      if (const double f = campaign::figure_of(t, metric, results.horizon_s); std::isfinite(f))
        by_cave[t.cave].push_back(f);
  Figures figures;
  for (auto& [cave, flown] : by_cave)
    if (flown.size() >= 2) figures.push_back(flown);
  return figures;
}

/// A campaign of `seeds` pairs a cave, each of two different flights; the second contestant's figure is
/// `factor` times what was flown.
CampaignResults draw(const Figures& flown, int seeds, double factor, int metric, double horizon_s,
                     core::Random& random) {
  CampaignResults c;
  c.horizon_s = horizon_s;
  c.contestants.resize(2);
  c.contestants[0].name = "itself";
  c.contestants[1].name = "changed";
  c.caves.resize(flown.size());
  for (std::size_t cave = 0; cave < flown.size(); ++cave)
    for (int seed = 0; seed < seeds; ++seed) {
      const auto n = static_cast<double>(flown[cave].size());
      const auto one = static_cast<std::size_t>(random.uniform() * n);
      const auto other =
          (one + 1 + static_cast<std::size_t>(random.uniform() * (n - 1))) % flown[cave].size();
      for (const auto& [contestant, figure] :
           {std::pair(0, flown[cave][one]), {1, factor * flown[cave][other]}}) {
        auto& t = c.trials.emplace_back();
        t.contestant = static_cast<std::size_t>(contestant);
        t.cave = cave;
        t.seed = seed;
        t.figures.assign(evaluation::metric_definitions().size(), std::numeric_limits<double>::quiet_NaN());
        t.figures[static_cast<std::size_t>(metric)] = figure;
      }
    }
  return c;
}

struct Share {
  double different = 0, right = 0;  // of the campaigns: any difference called; the true one called
};
Share fraction_shown(const Figures& flown, int seeds, double factor, int metric, double horizon_s,
                     int campaigns) {
  const bool more =
      evaluation::metric_definitions()[static_cast<std::size_t>(metric)].better == evaluation::Better::more;
  campaign::VerdictOptions options{
      .metric = std::string(evaluation::metric_definitions()[static_cast<std::size_t>(metric)].name)};
  options.simulations = 0;
  options.resamples = 1000;
  core::Random random(17);
  Share fraction;
  for (int i = 0; i < campaigns; ++i) {
    options.seed = random.bits();
    const auto verdicts =
        campaign::compare_all(draw(flown, seeds, factor, metric, horizon_s, random), options);
    const auto shown = verdicts.find(0, 1, metric)->shown;
    fraction.different += shown != campaign::Shown::no_difference;
    fraction.right += shown == ((factor > 1) == more ? campaign::Shown::b_better : campaign::Shown::a_better);
  }
  return {fraction.different / campaigns, fraction.right / campaigns};
}

void experiment(const Figures& flown, int metric, double horizon_s) {
  std::size_t flights = 0;
  for (const auto& cave : flown) flights += cave.size();
  std::printf("  %zu flights in %zu caves\n", flights, flown.size());
  for (const int seeds : {3, 5, 10}) {
    std::printf("  %2d seeds: against itself different in %5.1f %% of 1000 campaigns", seeds,
                100 * fraction_shown(flown, seeds, 1, metric, horizon_s, 1000).different);
    std::printf("; crippled by 20 %%: shown in %5.1f %% of 200\n",
                100 * fraction_shown(flown, seeds, 0.8, metric, horizon_s, 200).right);
  }
  int needed = 0;
  for (int seeds = 2; seeds <= 400 && needed == 0; seeds += 1 + seeds / 10) {
    const double right = fraction_shown(flown, seeds, 1.05, metric, horizon_s, 400).right;
    if (right >= 0.8)
      needed = seeds, std::printf("  5 %% planted: %d seeds a cave show it in %.1f %% of 400 campaigns\n",
                                  seeds, 100 * right);
  }
  core::Random random(23);
  std::vector<int> forecasts;
  int held = 0;
  const int pilots = 100;
  campaign::VerdictOptions options{
      .metric = std::string(evaluation::metric_definitions()[static_cast<std::size_t>(metric)].name)};
  for (int i = 0; i < pilots; ++i) {
    const auto verdicts = campaign::compare_all(draw(flown, 10, 1, metric, horizon_s, random), options);
    const auto& f = verdicts.find(0, 1, metric)->forecast_worthwhile;
    forecasts.push_back(f.seeds);
    held += f.low <= needed && needed <= f.high;
  }
  std::sort(forecasts.begin(), forecasts.end());
  std::printf(
      "  forecast for 5 %% by %d pilot campaigns of 10 seeds: median %d, 80 %% of them %d to %d; its "
      "interval held what was needed in %d\n",
      pilots, forecasts[pilots / 2], forecasts[pilots / 10], forecasts[pilots * 9 / 10], held);
}

}  // namespace

int main(int argc, char** argv) try {
  std::vector<std::string> inputs(argv + 1, argv + argc);
  std::string metric = "coverage_auc";
  if (const auto m = std::find(inputs.begin(), inputs.end(), "--metric");
      m != inputs.end() && m + 1 != inputs.end()) {
    metric = m[1];
    inputs.erase(m, m + 2);
  }
  const int index = evaluation::metric_index(metric);
  if (inputs.empty() || index < 0) {
    std::fprintf(stderr, "verdict_experiment STORE|RUN... [--metric FIGURE]\n");
    return 2;
  }
  const bool runs = std::filesystem::exists(inputs.front() + "/metrics.json");
  const CampaignResults results = runs ? read_runs(inputs) : campaign::read_results(inputs.front());
  std::printf("%s, horizon %g s\n", metric.c_str(), results.horizon_s);
  for (std::size_t i = 0; i < results.contestants.size(); ++i) {
    const Figures flown = figures_of(results, i, index);
    if (flown.empty()) continue;
    std::printf("%s\n", results.contestants[i].name.c_str());
    experiment(flown, index, results.horizon_s);
  }
  campaign::VerdictOptions options;
  options.metric = metric;
  const auto verdicts = campaign::compare_all(results, options);
  for (const auto& c : verdicts.comparisons)
    if (c.metric == index) std::printf("%s\n", c.sentence.c_str());
  for (const auto& p : verdicts.ranking)
    std::printf("%s: place %d to %d, group %s, mean %.4f\n", results.contestants[p.contestant].name.c_str(),
                p.best, p.worst, p.groups.c_str(), p.mean);
  std::printf("%s\n", verdicts.sentence.c_str());
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
