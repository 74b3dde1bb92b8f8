#include "core_stack/mission/policy/fallback_policy.h"

#include <algorithm>
#include <cmath>

namespace karst::core {

Decision FallbackPolicy::decide(const DecisionRequest& request) {
  Decision decision;
  for (const FrontierOffer& offer : request.frontiers) {
    if (!std::isfinite(offer.path_length_m)) continue;
    Goal goal;
    goal.position = offer.viewpoint;
    goal.heading_rad = offer.viewpoint_heading_rad;
    goal.frontier_id = offer.cluster->id;
    goal.score = -offer.path_length_m;
    goal.why = "fallback: the nearest frontier";
    decision.goals.push_back(goal);
  }
  std::stable_sort(decision.goals.begin(), decision.goals.end(),
                   [](const Goal& a, const Goal& b) { return a.score > b.score; });
  decision.goals.resize(std::min<std::size_t>(decision.goals.size(), 16));
  decision.outcome = decision.goals.empty() ? Outcome::explored : Outcome::goals;
  decision.reason = decision.goals.empty() ? "no frontier can be reached" : "";
  return decision;
}

}  // namespace karst::core
