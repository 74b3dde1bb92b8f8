// Campaigns drawn from known distributions, so that what a verdict ought to say is known.
#pragma once
#include <functional>
#include <map>

#include "core_stack/common/random.h"
#include "sdk/campaign/store/results.h"

namespace karst::test {

/// Sets figures by name; those left out are unknown.
using Figures = std::map<std::string, double>;

/// Contestants A, B, C ..., caves "cave 1" ..., seeds from 1; the horizon is 390 s. `fly` is asked in the
/// order contestant, cave, seed.
campaign::CampaignResults drawn_campaign(
    std::size_t contestants, std::size_t caves, std::int64_t seeds,
    const std::function<Figures(std::size_t contestant, std::size_t cave, std::int64_t seed)>& fly);

/// A trial's value of a figure, to change it.
double& figure(campaign::TrialResult& trial, const std::string& name);

/// Mean coverage of a flight: caves differ in what is typical (0.3 to 0.8) and in how much seeds spread;
/// pairs share a part of what their seed does.
class CoverageModel {
 public:
  explicit CoverageModel(std::uint64_t seed) : seed_(seed) {}
  double operator()(std::size_t contestant, std::size_t cave, std::int64_t seed, double factor = 1) const;

 private:
  std::uint64_t seed_;
};

}  // namespace karst::test
