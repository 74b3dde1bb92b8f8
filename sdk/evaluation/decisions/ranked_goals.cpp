#include "sdk/evaluation/decisions/ranked_goals.h"

#include <algorithm>
#include <utility>

#include "core_stack/common/json_text.h"

namespace karst::evaluation {
namespace {

using core::Vec3;
using nlohmann::json;
namespace event = core::event;

constexpr double kSamePlace_m = 1e-6;  // as events and answers hold a goal
constexpr double kUnderWay_m = 0.3;    // nearer than this the vehicle flies on to the goal that it has

Vec3 place_of(const json& goal) {
  Vec3 p = Vec3::Constant(event::kUnknown);
  const auto found = goal.find("position");
  if (found == goal.end() || !found->is_array() || found->size() != 3) return p;
  for (std::size_t i = 0; i < 3; ++i)
    if ((*found)[i].is_number()) p[static_cast<Eigen::Index>(i)] = (*found)[i].get<double>();
  return p;
}

std::uint32_t frontier_of(const json& goal) {
  const auto found = goal.find("frontier");
  return found != goal.end() && found->is_number_unsigned() ? found->get<std::uint32_t>() : 0;
}

RankedGoal tried_goal(const event::Goal& g, std::string fate) {
  return {g.position, g.score, 0, g.frontier, g.why, std::move(fate)};
}

std::string fate_in(const DecisionRecord& d, const Vec3& place) {
  const auto is_here = [&](const event::Goal& g) {  // the fallback's goal may lie at the same place
    return (g.position - place).norm() < kSamePlace_m && !is_of_fallback(tried_goal(g, ""));
  };
  if (d.accepted && is_here(*d.accepted)) return "accepted";
  const auto refused = std::find_if(d.refused.begin(), d.refused.end(), is_here);
  if (refused != d.refused.end()) return "refused: " + refused->reason;
  const bool under_way =
      !d.accepted && d.flown && d.flown->position && (*d.flown->position - place).norm() < kUnderWay_m;
  return under_way ? "under way already" : "not tried";
}

}  // namespace

std::optional<JudgedAnswer> judged(const RecordedAnswer& recorded, const DecisionRecord& d) {
  const json answer = core::json_of(recorded.answer);
  if (!answer.is_object()) return std::nullopt;
  JudgedAnswer out;
  out.failure = event_text(answer, "failure");
  if (!out.failure.empty()) return out;
  const auto goals = answer.find("goals");
  if (goals == answer.end() || !goals->is_array()) return std::nullopt;
  out.outcome = event_text(answer, "outcome");
  out.reason = event_text(answer, "reason");
  for (const json& goal : *goals) {
    const Vec3 place = place_of(goal);
    out.goals.push_back({place, event_number(goal, "score").value_or(event::kUnknown),
                         event_number(goal, "max_speed").value_or(0), frontier_of(goal),
                         event_text(goal, "why"), fate_in(d, place)});
  }
  return out;
}

std::vector<RankedGoal> tried_goals(const DecisionRecord& d) {
  std::vector<RankedGoal> goals;
  for (const event::Goal& g : d.refused) goals.push_back(tried_goal(g, "refused: " + g.reason));
  if (d.accepted) goals.push_back(tried_goal(*d.accepted, "accepted"));
  return goals;
}

bool is_of_fallback(const RankedGoal& goal) { return goal.why.starts_with(std::string(kFallback) + ": "); }

}  // namespace karst::evaluation
