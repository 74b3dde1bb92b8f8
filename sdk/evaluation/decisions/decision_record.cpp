#include "sdk/evaluation/decisions/decision_record.h"

#include <limits>
#include <map>
#include <utility>

#include "sdk/evaluation/decisions/goal_spans.h"

namespace karst::evaluation {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
namespace event = core::event;

constexpr double kClockRounding_s = 0.005;
constexpr double kSameTime_s = 1e-6;

/// Goes on through the spans of a goal that was planned anew.
FlownGoal flown_goal(const ordered_json& spans, std::size_t i) {
  FlownGoal goal;
  const ordered_json& first = spans[i];
  goal.accepted_s = first.at("t").get<double>();
  if (const ordered_json& p = first.at("position"); !p.is_null())
    goal.position = core::Vec3(p.at(0).get<double>(), p.at(1).get<double>(), p.at(2).get<double>());
  for (; i < spans.size(); ++i) {
    const ordered_json& span = spans[i];
    if (goal.until_s && span.at("t").get<double>() != *goal.until_s) continue;  // another goal's
    const ordered_json& until = span.at("until");
    goal.until_s = until.is_null() ? std::nullopt : std::optional(until.get<double>());
    goal.fate = span.at("fate").get<std::string>();
    goal.reason = span.at("fate_reason").get<std::string>();
    if (goal.fate != kPlannedAnew) break;
    ++goal.planned_anew;
  }
  return goal;
}

/// The goal accepted at this time, or else the one accepted last of those under way then.
std::optional<FlownGoal> goal_flown_at(const ordered_json& spans, double t_s) {
  for (std::size_t i = spans.size(); i-- > 0;) {
    const double from_s = spans[i].at("t").get<double>();
    const ordered_json& until = spans[i].at("until");
    const bool open = until.is_null() || until.get<double>() > t_s;
    if (from_s == t_s || (from_s < t_s && open)) return flown_goal(spans, i);
  }
  return std::nullopt;
}

/// Takes what an event of the decision's time says of it.
void take(const json& e, DecisionRecord& d) {
  if (const auto goal = event::as<event::Goal>(e)) {
    if (goal->state == event::GoalState::accepted) d.accepted = goal;
    if (goal->state == event::GoalState::rejected) d.refused.push_back(*goal);
  }
  if (const auto frontiers = event::as<event::Frontiers>(e)) d.offered = frontiers->clusters;
  if (const auto frontier = event::as<event::Frontier>(e)) d.unseen.push_back(*frontier);
}

}  // namespace

std::vector<DecisionRecord> decisions_of(const RunRecord& run) {
  std::vector<DecisionRecord> all;
  std::multimap<double, std::size_t> at;  // time: place in the list
  double previous_s = -std::numeric_limits<double>::infinity();
  std::string phase, flown_policy;
  std::optional<double> failed_s;
  for (const json& e : run.events) {
    if (const auto entered = event::as<event::Phase>(e)) phase = core::name_of(entered->phase);
    if (const auto safety = event::as<event::Safety>(e);
        safety && safety->action == core::SafetyAction::fallback && !failed_s)
      failed_s = e["t"].get<double>();
    const auto decision = event::as<event::Decision>(e);
    if (!decision) continue;
    at.emplace(e["t"].get<double>(), all.size());
    DecisionRecord& d = all.emplace_back();
    d.number = all.size();
    d.t_s = e["t"].get<double>();
    d.previous_s = previous_s;
    d.phase = phase;
    d.decision = *decision;
    previous_s = d.t_s;
    if (flown_policy.empty() && d.decision.policy != kFallback) flown_policy = d.decision.policy;
  }
  for (const json& e : run.events) {
    const auto [first, last] = at.equal_range(e["t"].get<double>());
    for (auto i = first; i != last; ++i) take(e, all[i->second]);
  }
  const ordered_json spans = goal_spans(run);
  for (DecisionRecord& d : all) {
    d.of = all.size();
    d.flown_policy = flown_policy;
    d.policy_failed = failed_s && *failed_s <= d.t_s;
    d.flown = goal_flown_at(spans, d.t_s);
    if (!run.estimate.empty()) d.vehicle = pose_at(run.estimate, d.t_s).position;
  }
  return all;
}

std::optional<DecisionRecord> decision_at(const RunRecord& run, double t_s) {
  std::optional<DecisionRecord> found;
  for (DecisionRecord& d : decisions_of(run))
    if (d.t_s <= t_s + kClockRounding_s) found = std::move(d);
  return found;
}

bool was_asked_for(const DecisionRecord& d, double request_s) {
  return request_s > d.previous_s - kSameTime_s && request_s < d.t_s - kSameTime_s;
}

}  // namespace karst::evaluation
