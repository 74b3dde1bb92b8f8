#include "tests/unit/campaign/verdict/drawn_campaign.h"

#include <limits>
#include <stdexcept>

#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::test {

double& figure(campaign::TrialResult& trial, const std::string& name) {
  const int i = evaluation::metric_index(name);
  if (i < 0) throw std::invalid_argument(name);
  return trial.figures[static_cast<std::size_t>(i)];
}

campaign::CampaignResults drawn_campaign(
    std::size_t contestants, std::size_t caves, std::int64_t seeds,
    const std::function<Figures(std::size_t contestant, std::size_t cave, std::int64_t seed)>& fly) {
  campaign::CampaignResults results;
  results.name = "drawn";
  results.horizon_s = 390;
  for (std::size_t i = 0; i < contestants; ++i)
    results.contestants.emplace_back().name = std::string(1, static_cast<char>('A' + i));
  for (std::size_t i = 0; i < caves; ++i) results.caves.emplace_back().name = "cave " + std::to_string(i + 1);
  for (std::size_t contestant = 0; contestant < contestants; ++contestant)
    for (std::size_t cave = 0; cave < caves; ++cave)
      for (std::int64_t seed = 1; seed <= seeds; ++seed) {
        campaign::TrialResult& t = results.trials.emplace_back();
        t.contestant = contestant;
        t.cave = cave;
        t.seed = seed;
        t.outcome = "landed";
        t.figures.assign(evaluation::metric_definitions().size(), std::numeric_limits<double>::quiet_NaN());
        for (const auto& [name, value] : fly(contestant, cave, seed)) figure(t, name) = value;
      }
  return results;
}

double CoverageModel::operator()(std::size_t contestant, std::size_t cave, std::int64_t seed,
                                 double factor) const {
  const auto draw = [&](const std::string& what) {
    return core::Random::stream(seed_, what + " " + std::to_string(cave) + " " + std::to_string(seed))
        .normal();
  };
  const double typical = 0.3 + 0.1 * static_cast<double>(cave % 6),
               spread = 0.02 + 0.01 * static_cast<double>(cave % 3);
  const double shared = draw("gusts"), own = draw("contestant " + std::to_string(contestant));
  return factor * (typical + spread * (0.6 * shared + 0.8 * own));
}

}  // namespace karst::test
