#include "sdk/evaluation/decisions/decided_by.h"

#include <algorithm>

#include "sdk/evaluation/decisions/ranked_goals.h"

namespace karst::evaluation {
namespace {

// As mission control words the ends that are not due to the cave (metrics/ending.cpp).
constexpr const char* kTooFarForBattery = "what is left is too far for the battery";
constexpr const char* kTooFarForTime = "what is left is too far for the time allowed";

}  // namespace

std::string decided_by(const DecisionRecord& d) {
  if (d.decision.policy != kFallback) return d.decision.policy;
  const std::string policy = d.flown_policy.empty() ? "the policy" : d.flown_policy;
  if (d.policy_failed) return "the fallback, because " + policy + " failed";
  const std::vector<RankedGoal> tried = tried_goals(d);
  const bool refused =
      std::any_of(tried.begin(), tried.end(), [](const RankedGoal& goal) { return !is_of_fallback(goal); });
  return "the fallback, because " +
         (refused ? "all goals of " + policy + " were refused" : policy + " gave no goal");
}

std::string outcome_words(const DecisionRecord& d) {
  const std::string& reason = d.decision.reason;
  if (d.decision.outcome == core::Outcome::explored) {
    if (reason == kTooFarForTime) return "nothing within reach in the time left";
    if (reason == kTooFarForBattery) return "nothing within reach with the battery left";
  }
  return core::name_of(d.decision.outcome) + (reason.empty() ? "" : ", " + reason);
}

}  // namespace karst::evaluation
