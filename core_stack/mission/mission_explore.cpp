// Exploring: when the policy is asked, and how its goal joins the trajectory in flight.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "core_stack/common/json_text.h"
#include "core_stack/mission/json_point.h"
#include "core_stack/mission/mission_control.h"

namespace karst::core {
namespace {

/// Between two rounds: time for a scan or two to come in at a place just reached.
constexpr TimeNs kPause = 400 * kMillisecond;
constexpr double kSameGoal_m = 0.3;
constexpr double kProgress_m = 0.5;
constexpr double kFacing_rad = 0.2;  // a goal's heading is reached when nearer than this

nlohmann::json to_json(const Goal& goal, const char* state, const std::string& reason) {
  nlohmann::json j{{"position", list(goal.position)},
                   {"frontier", goal.frontier_id},
                   {"score", goal.score},
                   {"why", goal.why},
                   {"state", state},
                   {"reason", reason}};
  j["heading"] = std::isfinite(goal.heading_rad) ? nlohmann::json(goal.heading_rad) : nlohmann::json();
  return j;
}

const char* state_of(PolicyEvent::Kind kind) {
  switch (kind) {
    case PolicyEvent::Kind::goal_reached:
      return "reached";
    case PolicyEvent::Kind::goal_rejected:
      return "rejected";
    case PolicyEvent::Kind::goal_unreachable:
      return "unreachable";
    case PolicyEvent::Kind::goal_abandoned:
      return "abandoned";
    case PolicyEvent::Kind::goal_superseded:
      return "superseded";
    case PolicyEvent::Kind::homing:
      return "homing";
  }
  return "?";
}

/// A drawing's fields in the event. Made on the map lane: a hundred thousand points take a fifth of a second.
std::string text_of(const Drawing& d) {
  static constexpr const char* kShapes[] = {"points", "lines", "text"};
  return json_text(nlohmann::json{{"shape", kShapes[static_cast<int>(d.kind)]},
                                  {"points", list(d.points)},
                                  {"rgb", d.rgb},
                                  {"text", d.text}});
}

}  // namespace

void MissionControl::settle_goal(GoalFate fate, PolicyEvent::Kind kind, const std::string& reason) {
  if (!goal_) return;
  recorder_.event(now(), "goal", to_json(*goal_, state_of(kind), reason));
  events_.push_back({kind, now(), *goal_, reason});
  if (goal_->frontier_id != 0 && (fate == GoalFate::reached || !goal_alive_))
    looked_at_.push_back(goal_->frontier_id);
  last_fate_ = fate;
  last_goal_ = goal_;
  goal_.reset();
}

void MissionControl::drop_next_goal(PolicyEvent::Kind kind, const std::string& reason) {
  if (!next_goal_) return;
  recorder_.event(now(), "goal", to_json(*next_goal_, state_of(kind), reason));
  events_.push_back({kind, now(), *next_goal_, reason});
  next_goal_.reset();
}

bool MissionControl::within_tolerance(const Goal& goal) const {
  const Reference& r = flight_.reference();
  return (r.position - goal.position).norm() < goal.tolerance_m &&
         (!std::isfinite(goal.heading_rad) ||
          std::abs(wrap_angle(r.heading_rad - goal.heading_rad)) < kFacing_rad);
}

void MissionControl::explore() {
  if (next_goal_ && goal_ && now() >= flight_.time_nearest(goal_->position)) {
    settle_goal(GoalFate::reached, PolicyEvent::Kind::goal_reached, "passed on the way to the next");
    goal_ = next_goal_;
    next_goal_.reset();
    append_tried_ = false;
  }
  if (encounter_.holds()) return;
  watch_progress();
  if (round_running_ || verdict_.action == SafetyAction::brake) return;
  if (detour_due_ && !flight_.at_rest(now())) {
    begin_round(false);
    return;
  }
  if (now() - last_round_ < kPause) return;

  if (flight_.at_rest(now())) {
    detour_due_ = false;
    if (goal_ && !path_blocked_) {
      settle_goal(GoalFate::reached, PolicyEvent::Kind::goal_reached, "");
      last_round_ = now();  // let the sensors look before the next goal is chosen
      return;
    }
    begin_round(false);
  } else if (path_blocked_ || next_goal_) {
    return;  // wait for the brake, or for the goal to be passed
  } else if (goal_ && within_tolerance(*goal_)) {
    settle_goal(GoalFate::reached, PolicyEvent::Kind::goal_reached, "");
    last_round_ = now();
  } else if (goal_ && !goal_alive_) {
    begin_round(false);
  } else if (flight_.remaining_s(now()) < options_.mission.append_before_s) {
    // What is appended is flown at its own speed limit, from here on: not where the present path has one.
    if (options_.mission.append && !append_tried_ && !path_limited_) begin_round(true);
    append_tried_ = true;
  } else if (now() - last_round_ > from_seconds(options_.mission.decision_period_s)) {
    begin_round(false);
  }
}

/// The way flown, and what is left of it until the lead's end.
std::vector<Vec3> MissionControl::way_to(const Flight::Onward& lead) const {
  std::vector<Vec3> way = flown_;
  way.insert(way.end(), lead.points.begin(), lead.points.end());
  return way;
}

void MissionControl::begin_round(bool appending) {
  round_running_ = true;
  last_round_ = now();
  const TimeNs budget = from_seconds(options_.mission.decision_budget_s);
  const Flight::Onward lead =
      appending ? flight_.until_end(now() + budget) : flight_.until_stop(now() + budget);
  RoundInput input;
  input.now = now();
  input.deadline = now() + budget;
  input.state = flight_.expected(input.deadline);
  input.from = lead.points.back();
  const Vec3 velocity = flight_.reference().velocity_mps;
  input.direction = velocity.norm() > 0.2 ? velocity.normalized()
                                          : Vec3(std::cos(lead.heading_rad), std::sin(lead.heading_rad), 0);
  input.seconds_left = seconds_left();
  input.way_come_m = flown_m_;
  input.way_come = way_to(lead);
  input.last_fate = goal_ ? GoalFate::under_way : last_fate_;
  input.last_goal = goal_ ? goal_ : last_goal_;
  input.standing = flight_.at_rest(now());
  input.appending = appending;
  input.events = std::exchange(events_, {});
  input.looked_at = std::exchange(looked_at_, {});
  if (team_) input.mates = team_->mates(now());
  auto result = std::make_shared<RoundResult>();
  auto way = std::make_shared<Route>();
  // The lead of an appended path ends at a goal.
  const std::optional<Goal> passed = appending ? goal_ : std::nullopt;
  const double cut_m = passed ? std::min(kMostCut_m, passed->tolerance_m) : kMostCut_m;
  executive_.job(
      "decision", Lane::map, budget,
      [this, input, lead, passed, cut_m, limits = flight_.limits(0), narrow = narrow_places_, result, way] {
        try {
          *result = explorer_.decide(input);
          for (const Drawing& d : std::exchange(result->drawings, {}))
            result->drawing_texts.push_back(text_of(d));
          if (result->goal)
            *way = route(lead, result->path, result->goal, passed, input.deadline, cut_m, limits, narrow);
        } catch (const std::exception& e) {  // whatever it is: the way home must not depend on it
          result->goal.reset();
          result->outcome = Outcome::go_home;
          result->reason = std::string("an error of the core: ") + e.what();
        }
      },
      [this, input, result, way] { on_round(input, *result, *way); });
}

void MissionControl::on_round(const RoundInput& input, const RoundResult& result, const Route& way) {
  round_running_ = false;
  record_round(input, result);
  if (phase_ != Phase::explore || (path_blocked_ && !flight_.at_rest(now()))) return;
  if (braked_since(input.now) || encounter_.holds())
    return;  // the path begins where the vehicle will not come any more

  if (result.goal) {
    const bool same = goal_ && (goal_->position - result.goal->position).norm() < kSameGoal_m;
    if (same && !path_blocked_ && !detour_due_ && !input.appending) return;  // keep to the path under way
    recorder_.event(now(), "goal", to_json(*result.goal, "accepted", ""));
    if (team_) claim_goal(result.goal);
    if (input.appending && goal_) {
      next_goal_ = result.goal;
    } else {
      if (!same)
        settle_goal(GoalFate::superseded, PolicyEvent::Kind::goal_superseded,
                    goal_alive_ ? "the policy chose another" : "its frontier has been seen");
      goal_ = result.goal;
      append_tried_ = false;
    }
    follow(way);
    goal_alive_ = true;
  } else if (input.appending) {
    return;  // ask again on arrival
  } else if (result.outcome == Outcome::explored && flight_.at_rest(now())) {
    begin_homing((result.out_of_time ? "" : "explored: ") + result.reason);
  } else if (result.outcome == Outcome::go_home) {
    begin_homing("the policy asked for it: " + result.reason);
  } else if (path_blocked_ && flight_.at_rest(now())) {
    settle_goal(GoalFate::unreachable, PolicyEvent::Kind::goal_unreachable, result.reason);
    path_blocked_ = false;
  } else if (!result.rejected.empty() && !goal_) {
    last_fate_ = GoalFate::rejected;
    last_goal_ = result.rejected.front().goal;
  }
}

void MissionControl::watch_progress() {
  const Vec3& here = flight_.reference().position;
  if (!goal_ || (here - last_landmark_).norm() > kProgress_m) {
    last_landmark_ = here;
    last_landmark_time_ = now();
    return;
  }
  if (now() - last_landmark_time_ < from_seconds(options_.mission.goal_timeout_s)) return;
  settle_goal(GoalFate::abandoned, PolicyEvent::Kind::goal_abandoned, "no progress towards it");
  drop_next_goal(PolicyEvent::Kind::goal_superseded, "the goal before it was abandoned");
  if (!flight_.at_rest(now())) brake();
}

void MissionControl::record_round(const RoundInput& input, const RoundResult& result) {
  static constexpr const char* kOutcomes[] = {"goals", "hold", "explored", "go_home"};
  recorder_.decision_cost(now(), result.decide_ms, result.plan_ms);
  recorder_.event(now(), "decision",
                  {{"policy", result.policy},
                   {"outcome", kOutcomes[static_cast<int>(result.outcome)]},
                   {"goals", result.goals_proposed},
                   {"reason", result.reason},
                   {"appending", input.appending},
                   {"frontiers", result.frontiers.size()}});
  nlohmann::json clusters = nlohmann::json::array();
  for (const FrontierCluster& c : result.frontiers)
    clusters.push_back({c.id, c.centroid.x(), c.centroid.y(), c.centroid.z(), c.unknown_cells});
  recorder_.event(now(), "frontiers", {{"clusters", clusters}});
  if (!result.policy_failure.empty())
    recorder_.event(now(), "safety",
                    {{"action", "fallback"}, {"reason", "the policy failed: " + result.policy_failure}});
  for (const UnseenFrontier& u : result.unseen)
    recorder_.event(
        now(), "frontier",
        {{"id", u.id}, {"position", list(u.position)}, {"state", "refused"}, {"reason", u.reason}});
  for (const RejectedGoal& r : result.rejected)
    recorder_.event(now(), "goal", to_json(r.goal, "rejected", r.reason));
  for (const std::string& drawing : result.drawing_texts) recorder_.event_of_text(now(), "drawing", drawing);
  for (const std::string& text : result.log) recorder_.event(now(), "log", {{"text", text}});
}

}  // namespace karst::core
