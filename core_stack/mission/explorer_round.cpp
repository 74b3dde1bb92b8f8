// A round of decision: what is offered to the policy, what it wants, and the first of its goals that can be
// flown to.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core_stack/homing/home.h"
#include "core_stack/mission/explorer.h"
#include "core_stack/planning/grid_planner.h"

namespace karst::core {
namespace {

/// A round tries no more plans than this: the rest of a ranked list waits for the next round.
constexpr int kMostPlans = 5;
/// A vehicle that stands for so long, because the policy holds it or because none of its goals can be
/// accepted, gets its next goal from the fallback.
constexpr TimeNs kMostIdle = 2 * kSecond;

constexpr const char* kTooFar = "the battery, or the time allowed, does not last for going there and home";

double elapsed_ms(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - since).count();
}

/// A path flown at next to no speed would hold the vehicle until the battery calls it home.
std::optional<std::string> too_slow(const Goal& goal, const MotionLimits& limits) {
  const double least_mps = std::min(limits.min_speed_mps, limits.max_speed_mps);
  if (goal.max_speed_mps == 0 || goal.max_speed_mps >= least_mps) return std::nullopt;
  char text[96];
  std::snprintf(text, sizeof text, "its speed limit of %.2g m/s is below motion.min_speed, %g m/s",
                goal.max_speed_mps, least_mps);
  return text;
}

bool any_in_reach(const std::vector<FrontierOffer>& offers) {
  return std::any_of(offers.begin(), offers.end(),
                     [](const FrontierOffer& o) { return std::isfinite(o.path_length_m); });
}

}  // namespace

Decision Explorer::ask(const DecisionRequest& request, bool passed_over, RoundResult& result) {
  if (!policy_failed_ && !passed_over) {
    try {
      result.policy = policy_->name();
      return policy_->decide(request);
    } catch (const PolicyFailure& failure) {
      policy_failed_ = true;
      result.policy_failure = failure.what();
    }
  }
  result.policy = fallback_.name();
  return fallback_.decide(request);
}

std::optional<std::string> Explorer::objection(const Reach& reach, const Goal& goal) const {
  const Vec3& p = goal.position;
  if (!p.allFinite()) return "its position is not finite";
  if (std::isinf(goal.heading_rad)) return "its heading is not finite";
  if (const auto why = too_slow(goal, options_.motion)) return why;
  if (map_.at(p) != Cell::free)
    return map_.at(p) == Cell::occupied ? "it lies in an occupied cell" : "it lies in unknown space";
  if (!is_clear(map_, p, reach.planning.clearance_m)) return "it is too near to rock or unknown space";
  if (const auto why = ledger_.closed(map_, p, closed_at_, by_pause_alone_))
    return "it was tried before: " + *why;
  return std::nullopt;
}

/// False if goals were left that another round will come to, because places before them are closed now.
bool Explorer::choose(const Reach& reach, const RoundInput& input, const std::vector<Goal>& goals,
                      RoundResult& result) {
  int plans = 0, closed = 0;
  for (const Goal& goal : goals) {
    if (plans == kMostPlans) return closed == 0;
    std::string why;
    if (const auto problem = objection(reach, goal)) {
      why = *problem;
    } else {
      ++plans;
      const Path path = plan_in(reach, input.from, goal.position);
      const auto blind = path.found() ? blind_climb(view_, input.way_come, path.points) : std::nullopt;
      if (blind) {
        why = *blind;
        ledger_.close(map_, goal.position, input.now, why), ++closed;
      } else if (path.found()) {
        const HomeEstimate home = estimate_home(goal.position, input.way_come_m + path.length_m);
        const double there_s = flight_time_s(path.length_m, options_.motion);
        if (home_slack_s(input.seconds_left - there_s, home.time_s, options_.mission.home_margin,
                         options_.mission.home_reserve_s) > 0) {
          result.goal = goal;
          result.path = path;
          if (goal.frontier_id != 0) {
            const auto cluster = frontiers_.clusters().find(goal.frontier_id);
            if (cluster != frontiers_.clusters().end() &&
                (!input.last_goal || input.last_goal->frontier_id != goal.frontier_id))
              chosen_[goal.frontier_id] = {cluster->second.cells.size(), cluster->second.centroid};
          }
          return true;
        }
        why = kTooFar;
      } else {
        why = "no path: " + path.reason;
        ledger_.close(map_, goal.position, input.now, why), ++closed;
      }
    }
    result.rejected.push_back({goal, why});
  }
  return true;
}

void Explorer::tell(const std::vector<PolicyEvent>& events, TimeNs now) {
  for (const PolicyEvent& event : events) {
    if (!policy_failed_) policy_->notify(event);
    if (event.kind == PolicyEvent::Kind::goal_abandoned)
      ledger_.close(map_, event.goal.position, now, event.reason);
  }
}

DecisionRequest Explorer::request(const Reach& reach, const RoundInput& input) {
  DecisionRequest request;
  request.stamp = input.now;
  request.deadline = input.deadline;
  request.sequence = ++sequence_;
  request.state = input.state;
  request.direction_of_flight = input.direction;
  request.T_world_start = vehicle_.T_world_start;
  const HomeEstimate home = estimate_home(input.from, input.way_come_m);
  request.seconds_before_homing = home_slack_s(input.seconds_left, home.time_s, options_.mission.home_margin,
                                               options_.mission.home_reserve_s);
  request.max_speed_mps = options_.motion.max_speed_mps;
  request.clearance_m = reach.planning.clearance_m;
  request.vehicle_radius_m = vehicle_.radius_m;
  request.last_fate = input.last_fate;
  if (input.last_goal) request.last_goal = input.last_goal->position;
  request.map = &map_;
  request.roadmap = &reach.roadmap;
  if (vehicle_.rgb) request.imaged = &imaged_;
  for (const HeardMate& mate : input.mates) request.teammates.push_back(seen_by_policy(mate, input.now));
  request.vehicle = &vehicle_;
  return request;
}

/// Asks for a goal among `request.frontiers` and plans to it. Of two askings in a round the last one counts.
void Explorer::settle(const Reach& reach, const RoundInput& input, const DecisionRequest& request,
                      bool passed_over, RoundResult& result) {
  const auto begin = std::chrono::steady_clock::now();
  Decision decision = ask(request, passed_over, result);
  const double asked_ms = elapsed_ms(begin);
  output_budget_.trim(decision);
  result.decide_ms += asked_ms;
  result.outcome = decision.outcome;
  result.reason = decision.reason;
  result.drawings = std::move(decision.drawings);
  result.log.insert(result.log.end(), decision.log.begin(), decision.log.end());
  result.goals_proposed += decision.goals.size();
  if (decision.outcome == Outcome::goals) {
    const std::size_t before = result.rejected.size();
    bool all_tried = choose(reach, input, decision.goals, result);
    const std::size_t own = result.rejected.size();
    // Waiting brings no battery back: goals that are all too far are no reason to stand and ask again.
    const bool all_too_far = own > before && std::all_of(result.rejected.begin() + static_cast<long>(before),
                                                         result.rejected.end(), [](const RejectedGoal& r) {
                                                           return r.reason == kTooFar;
                                                         });
    if (!result.goal && all_too_far && result.policy != fallback_.name()) {
      result.policy = fallback_.name();
      all_tried = choose(reach, input, fallback_.decide(request).goals, result);
    }
    if (!result.goal) {
      // The fallback asks for every frontier in reach: if none of those can be flown to, nothing is left to
      // do.
      const bool last_resort = result.policy == fallback_.name() && all_tried;
      result.outcome = last_resort ? Outcome::explored : Outcome::hold;
      result.out_of_time = last_resort && all_too_far;
      result.reason = result.out_of_time ? "what is left is too far for the battery, or for the time allowed"
                      : last_resort      ? "no frontier left that can be accepted"
                      : !all_tried       ? "none of the goals tried so far could be accepted"
                                         : "no goal of the policy could be accepted";
    }
    if (!policy_failed_)
      for (std::size_t i = before; i < own; ++i)
        policy_->notify({PolicyEvent::Kind::goal_rejected, input.now, result.rejected[i].goal,
                         result.rejected[i].reason});
  }
  result.frontiers.clear();
  for (const FrontierOffer& offer : request.frontiers) {
    FrontierCluster brief = *offer.cluster;
    brief.cells.clear();
    result.frontiers.push_back(std::move(brief));
  }
}

RoundResult Explorer::decide(const RoundInput& input) {
  RoundResult result;
  const auto begin = std::chrono::steady_clock::now();
  tell(input.events, input.now);
  // What was looked at and opens again right there is mostly noise at a wall: it may wait.
  for (const std::uint32_t id : input.looked_at)
    if (const auto chosen = chosen_.find(id); chosen != chosen_.end())
      ledger_.close(map_, chosen->second.centroid, input.now, "looked at a short while ago");

  // Narrow passages come last: when nothing else is in reach, and when nothing else could be flown to. What
  // the goal under way will show may still be more.
  Reach& first = reach_at(input.from);  // up to date from here on: the map does not change within a round
  const bool passed_over = idle_since_ && input.now - *idle_since_ >= kMostIdle;  // all the round long
  DecisionRequest asked = request(first, input);
  asked.frontiers = offers_now(first, input);
  const bool may_be_narrow = &first == &wide_ && narrow_clearance_m_ && !input.appending;
  if (!may_be_narrow || any_in_reach(asked.frontiers)) settle(first, input, asked, passed_over, result);
  const bool nothing_left = result.outcome == Outcome::explored && !result.out_of_time;
  if (may_be_narrow && (!any_in_reach(asked.frontiers) || nothing_left)) {
    Reach& tight = *narrow();
    asked = request(tight, input);
    asked.frontiers = offers_now(tight, input);
    settle(tight, input, asked, passed_over, result);
  }

  if (passed_over) idle_since_.reset();
  if (result.goal || !input.standing) {
    idle_since_.reset();
  } else if (!idle_since_) {
    idle_since_ = input.now;
  }
  result.unseen = std::exchange(unseen_, {});
  result.plan_ms = elapsed_ms(begin) - result.decide_ms;
  return result;
}

}  // namespace karst::core
