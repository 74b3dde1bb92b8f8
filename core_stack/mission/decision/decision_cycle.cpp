#include "core_stack/mission/decision/decision_cycle.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace karst::core {
namespace {

double elapsed_ms(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - since).count();
}

/// Copies for the report, which does not show their cells.
std::vector<FrontierCluster> without_cells(const std::vector<FrontierOffer>& offers) {
  std::vector<FrontierCluster> out;
  for (const FrontierOffer& offer : offers) {
    FrontierCluster brief = *offer.cluster;
    brief.cells.clear();
    out.push_back(std::move(brief));
  }
  return out;
}

/// Handles a list without an acceptable goal. The fallback proposes every reachable frontier: if it has tried
/// all of them, nothing is left to explore.
void give_up(const GoalChoice& tried, const CycleInput& input, bool all_too_far, DecidedBy by,
             CycleResult& result) {
  const bool last_resort = by == DecidedBy::fallback && !tried.more_to_try;
  result.outcome = last_resort ? Outcome::explored : Outcome::hold;
  result.out_of_time = last_resort && all_too_far;
  if (result.out_of_time)
    result.reason = input.limited_by_time() ? "what is left is too far for the time allowed"
                                            : "what is left is too far for the battery";
  else if (last_resort)
    result.reason = "no frontier left that can be accepted";
  else
    result.reason = tried.more_to_try ? "none of the goals tried so far could be accepted"
                                      : "no goal of the policy could be accepted";
}

}  // namespace

DecisionCycle::DecisionCycle(const CoreOptions& options, const VehicleDescription& vehicle,
                             PolicyPort& policy, WorldModel& world, HomeEstimator& home)
    : vehicle_(vehicle),
      max_speed_mps_(options.motion.max_speed_mps),
      max_acceleration_mps2_(options.motion.max_acceleration_mps2),
      world_(&world),
      home_(&home),
      offers_(options, vehicle, world, ledger_),
      selection_(options, vehicle, world, home, ledger_),
      policy_(policy) {}

CycleResult DecisionCycle::decide(const CycleInput& input, const Claims& claims) {
  CycleResult result;
  const auto begin = std::chrono::steady_clock::now();
  tell(input.events, input.now);
  // A frontier that reopens where one was just seen is mostly noise at a wall: it may wait.
  for (const std::uint32_t id : input.looked_at)
    if (const auto place = chosen_.centroid(id))
      ledger_.close(world_->map(), *place, input.now, "looked at a short while ago");

  ask(policy_.begin_cycle(input.now), input, claims, result);
  if (result.outcome == Outcome::hold && input.standing && policy_.fallback_stands_by())
    ask(DecidedBy::fallback, input, claims, result);

  if (result.goal || !input.standing) {
    policy_.note_busy();
  } else if (result.outcome == Outcome::explored) {
    policy_.note_explored(result.decided_by);
  } else {
    policy_.note_idle(input.now);
  }
  result.unseen = offers_.take_unseen();
  result.plan_ms = elapsed_ms(begin) - result.decide_ms;
  return result;
}

/// Narrow passages come last: when nothing else is reachable, or no other goal was acceptable. They must wait
/// while the current goal may still reveal more.
void DecisionCycle::ask(DecidedBy by, const CycleInput& input, const Claims& claims, CycleResult& result) {
  const ClearanceRoadmap& first = world_->roadmap_at(input.from);
  const Question question = ask_about(first, input, claims);
  const bool in_range = any_reachable(question.request.frontiers);
  const bool may_be_narrow =
      first.passages() == Passages::usual && world_->allows_narrow() && !input.appending;
  if (!may_be_narrow || in_range) answer(question, by, result);
  const bool nothing_left = result.outcome == Outcome::explored && !result.out_of_time;
  if (may_be_narrow && (!in_range || nothing_left))
    answer(ask_about(*world_->narrow(), input, claims), by, result);
}

void DecisionCycle::tell(const std::vector<PolicyEvent>& events, TimeNs now) {
  for (const PolicyEvent& event : events) {
    policy_.notify(event);
    if (event.kind == PolicyEvent::Kind::goal_abandoned)
      ledger_.close(world_->map(), event.goal.position, now, event.reason);
  }
}

bool DecisionCycle::cluster_alive(std::uint32_t id) const {
  const auto& clusters = world_->frontiers().clusters();
  const auto it = clusters.find(id);
  return it != clusters.end() && chosen_.worth_flying_to(it->second);
}

DecisionCycle::Question DecisionCycle::ask_about(const ClearanceRoadmap& roadmap, const CycleInput& input,
                                                 const Claims& claims) {
  Question question{request(roadmap, input), {&roadmap, &input, {}}};
  OfferQuery query{&roadmap, input.from, input.now, std::nullopt, claims};
  if (input.appending && input.last_goal) query.leave_out = input.last_goal->frontier_id;
  Offers offers = offers_.find(query);
  question.request.frontiers = std::move(offers.frontiers);
  question.goals.rules = offers.rules;
  return question;
}

DecisionRequest DecisionCycle::request(const ClearanceRoadmap& roadmap, const CycleInput& input) {
  DecisionRequest request;
  request.stamp = input.now;
  request.deadline = input.deadline;
  request.sequence = ++sequence_;
  request.state = input.state;
  request.direction_of_flight = input.direction;
  request.T_world_start = vehicle_.T_world_start;
  request.seconds_before_homing =
      home_->slack_s(input.seconds_left, home_->estimate(input.from, input.flown_length_m));
  request.battery_fraction = input.battery_fraction;
  request.battery_seconds_left = input.battery_seconds_left;
  request.mission_seconds_left = input.mission_seconds_left;
  request.max_speed_mps = max_speed_mps_;
  request.max_acceleration_mps2 = max_acceleration_mps2_;
  request.clearance_m = roadmap.clearance_m();
  request.vehicle_radius_m = vehicle_.radius_m;
  request.last_fate = input.last_fate;
  if (input.last_goal) request.last_goal = input.last_goal->position;
  request.map = &world_->map();
  request.roadmap = &roadmap.roadmap();
  request.imaged = world_->imaged();
  request.survey = world_->survey();
  for (const TeammateState& teammate : input.teammates)
    request.teammates.push_back(home_->seen_by_policy(teammate, input.now));
  request.vehicle = &vehicle_;
  return request;
}

/// If a cycle asks twice, the last answer counts.
void DecisionCycle::answer(const Question& question, DecidedBy by, CycleResult& result) {
  const auto begin = std::chrono::steady_clock::now();
  PolicyAnswer answer = policy_.ask(question.request, by);
  result.decide_ms += elapsed_ms(begin);
  result.policy = answer.name;
  result.decided_by = answer.by;
  if (!answer.failure.empty()) result.policy_failure = answer.failure;
  Decision& decision = answer.decision;
  result.outcome = decision.outcome;
  result.reason = decision.reason;
  result.drawings = std::move(decision.drawings);
  result.log.insert(result.log.end(), decision.log.begin(), decision.log.end());
  result.goals_proposed += decision.goals.size();
  if (decision.outcome == Outcome::goals) choose(question, answer, result);
  result.frontiers = without_cells(question.request.frontiers);
}

void DecisionCycle::choose(const Question& question, const PolicyAnswer& answer, CycleResult& result) {
  const CycleInput& input = *question.goals.input;
  const GoalChoice own = selection_.choose(question.goals, answer.decision.goals);
  GoalChoice last = own;
  DecidedBy by = answer.by;
  result.rejected.insert(result.rejected.end(), own.rejected.begin(), own.rejected.end());
  // Waiting does not recharge the battery: if all goals are too far, asking again is pointless.
  if (!own.goal && own.all_too_far && by == DecidedBy::policy) {
    const PolicyAnswer fallback = policy_.ask_fallback(question.request);
    by = fallback.by;
    result.policy = fallback.name;
    result.decided_by = fallback.by;
    last = selection_.choose(question.goals, fallback.decision.goals);
    result.rejected.insert(result.rejected.end(), last.rejected.begin(), last.rejected.end());
  }
  if (last.goal) {
    note_chosen(*last.goal, input);
    result.goal = last.goal;
    result.path = last.path;
  } else {
    give_up(last, input, own.all_too_far, by, result);
  }
  for (const RejectedGoal& r : own.rejected)
    policy_.notify({PolicyEvent::Kind::goal_rejected, input.now, r.goal, r.reason});
}

/// A frontier that is chosen again keeps its state of the first choice.
void DecisionCycle::note_chosen(const Goal& goal, const CycleInput& input) {
  if (input.last_goal && input.last_goal->frontier_id == goal.frontier_id) return;
  const auto& clusters = world_->frontiers().clusters();
  if (const auto it = clusters.find(goal.frontier_id); it != clusters.end()) chosen_.note(it->second);
}

}  // namespace karst::core
