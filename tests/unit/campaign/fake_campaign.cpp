#include "tests/unit/campaign/fake_campaign.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "sdk/evaluation/metrics/coverage_curve.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "sdk/evaluation/record/run_record.h"

namespace karst::test {
namespace {

using campaign::CampaignResults;
using campaign::TrialResult;
using evaluation::metric_definitions;
using evaluation::metric_index;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double& figure(TrialResult& t, const char* name) {
  return t.figures[static_cast<std::size_t>(metric_index(name))];
}

/// A normal number that depends on the seed and nothing else.
double draw(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  double sum = 0;  // of twelve uniform ones: close enough, and the same in every standard library
  for (int i = 0; i < 12; ++i) sum += static_cast<double>(random() >> 11) * 0x1p-53;
  return sum - 6;
}

/// Scales what was explored, and the curve with it.
void scale(TrialResult& t, double by) {
  for (const char* name : {"coverage", "coverage_auc", "explored_volume_m3", "path_length_m"}) {
    double& v = figure(t, name);
    v = std::string_view(name).starts_with("coverage") ? std::min(1.0, by * v) : by * v;
  }
  for (campaign::CurvePoint& p : t.curve) p.explored_m3 *= by, p.coverage = std::min(1.0, by * p.coverage);
}

std::string name_of(const char* what, std::size_t i) {
  return std::string(what) + "_" + std::to_string(i + 1);
}

std::vector<std::string> index_of(const std::map<std::string, std::size_t>& names) {
  std::vector<std::string> list(names.size());
  for (const auto& [name, i] : names) list[i] = name;
  return list;
}

}  // namespace

CampaignResults fake_campaign(std::size_t contestants, std::size_t caves, std::int64_t seeds,
                              double advantage, double noise) {
  CampaignResults r;
  r.name = "made up";
  r.horizon_s = 300;
  for (std::size_t c = 0; c < contestants; ++c)
    r.contestants.push_back(
        {name_of("policy", c), "lateral", "1.0", R"({"gain": )" + std::to_string(c) + "}", "{}"});
  for (std::size_t k = 0; k < caves; ++k) r.caves.push_back({name_of("cave", k), "cave.info", "", "", ""});
  for (std::size_t c = 0; c < contestants; ++c)
    for (std::size_t k = 0; k < caves; ++k)
      for (std::int64_t seed = 1; seed <= seeds; ++seed) {
        TrialResult t;
        t.contestant = c, t.cave = k, t.seed = seed;
        t.outcome = "landed", t.reason = "at the start";
        const double pair = draw(1000 * k + static_cast<std::uint64_t>(seed));
        const double own = draw(100000 * (c + 1) + 1000 * k + static_cast<std::uint64_t>(seed));
        const double rate = (1 - advantage * static_cast<double>(c)) * (1 + noise * (pair + 0.5 * own));
        const double size_m3 = 5000.0 * static_cast<double>(k + 1);
        for (int s = 0; s <= 60; ++s) {
          const double time_s = 5.0 * s, fraction = 1 - std::exp(-std::max(0.05, rate) * time_s /
                                                                 (120 + 60 * static_cast<double>(k)));
          t.curve.push_back({time_s, fraction * size_m3, fraction});
        }
        t.figures.assign(metric_definitions().size(), 1 + 0.1 * own);
        figure(t, "coverage") = t.curve.back().coverage;
        figure(t, "explored_volume_m3") = t.curve.back().explored_m3;
        double area = 0;
        for (const auto& p : t.curve) area += p.coverage / static_cast<double>(t.curve.size());
        figure(t, "coverage_auc") = area;
        figure(t, "flight_time_s") = 300;
        r.trials.push_back(std::move(t));
      }
  return r;
}

CampaignResults campaign_of_runs(const std::vector<std::filesystem::path>& runs, int repeat) {
  CampaignResults r;
  r.name = "finished runs";
  r.horizon_s = 300;
  std::map<std::string, std::size_t> policies, caves;
  for (const auto& dir : runs) {
    std::ifstream in(dir / "metrics.json");
    const auto m = nlohmann::json::parse(in, nullptr, false);
    if (!m.is_object()) continue;
    const evaluation::RunRecord run = evaluation::read_run(dir);
    TrialResult t;
    t.contestant = policies.try_emplace(m.value("policy", ""), policies.size()).first->second;
    t.cave = caves.try_emplace(m.value("cave", ""), caves.size()).first->second;
    t.outcome = m.value("outcome", ""), t.reason = m.value("reason", ""), t.run_dir = dir.string();
    for (const auto& definition : metric_definitions()) {
      const auto v = m.find(std::string(definition.name));
      t.figures.push_back(v != m.end() && v->is_number() ? v->get<double>() : kUnknown);
    }
    for (const auto& p : evaluation::coverage_curve(run, figure(t, "coverage")))
      if (t.curve.empty() || p.time_s >= t.curve.back().time_s + 1)
        t.curve.push_back({p.time_s, p.explored_m3, p.coverage});
    figure(t, "coverage_auc") =
        evaluation::mean_coverage(evaluation::coverage_curve(run, figure(t, "coverage")), r.horizon_s)
            .value_or(kUnknown);
    for (int k = 0; k < repeat; ++k) {
      TrialResult again = t;
      again.seed = m.value("seed", 0) + 100 * k;
      if (k > 0) scale(again, 1 + 0.08 * draw(static_cast<std::uint64_t>(k + 100 * r.trials.size())));
      r.trials.push_back(std::move(again));
    }
  }
  for (const std::string& name : index_of(policies)) r.contestants.push_back({name, name, "1.0", "{}", "{}"});
  for (const std::string& name : index_of(caves)) r.caves.push_back({name, name, "", "", ""});
  std::sort(r.trials.begin(), r.trials.end(), [](const TrialResult& a, const TrialResult& b) {
    return std::tie(a.contestant, a.cave, a.seed) < std::tie(b.contestant, b.cave, b.seed);
  });
  return r;
}

}  // namespace karst::test
