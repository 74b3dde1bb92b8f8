#include "core_stack/mission/phases/exploration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core_stack/mission/flight/trusted_speeds.h"

namespace karst::core {
namespace {

/// Between two decision cycles: time for a scan or two at a place just reached.
constexpr TimeNs kPause = 400 * kMillisecond;
constexpr TimeNs kSteeredPeriod = 1500 * kMillisecond;  // while the horizon is replanned
constexpr double kFacing_rad = 0.2;                     // a goal's heading is reached when nearer than this

/// A drawing's fields in the event. Serialized on the map lane: 100 000 points take 0.2 s.
std::string text_of(const Drawing& d) {
  return event::fields_text(event::Drawing{d.kind, d.points, d.rgb, d.text});
}

bool reached(const Reference& r, const Goal& goal) {
  return (r.position - goal.position).norm() < goal.tolerance_m &&
         (!std::isfinite(goal.heading_rad) ||
          std::abs(wrap_angle(r.heading_rad - goal.heading_rad)) < kFacing_rad);
}

struct Cycle {
  CycleResult result;
  Route route;
};

/// Runs on the map lane. Catches all failures, as the return home must not depend on the policy.
Cycle decide(Explorer& explorer, const CycleInput& input, const RouteStart& start, const CoreOptions& options,
             const VehicleDescription& vehicle) {
  Cycle cycle;
  CycleResult& result = cycle.result;
  try {
    result = explorer.decide(input);
    for (const Drawing& d : std::exchange(result.drawings, {})) result.drawing_texts.push_back(text_of(d));
    if (result.goal)
      cycle.route = make_route(explorer.map(), options, vehicle, start, result.path, result.goal);
  } catch (const std::exception& e) {
    result.goal.reset();
    result.outcome = Outcome::go_home;
    result.reason = std::string("an error of the core: ") + e.what();
  }
  return cycle;
}

}  // namespace

void Exploration::begin() {
  still_.restart(onboard_.flight.reference().position, onboard_.now());
  idle_since_.reset();
}

void Exploration::step() {
  pass_goal();
  if (parts_.path.yields() || parts_.path.held()) idle_since_.reset();  // nobody is asked
  if (parts_.path.yields()) return;
  watch_progress();
  if (cycle_running_ || parts_.path.held()) return;
  choose();
}

void Exploration::pass_goal() {
  const TimeNs now = onboard_.now();
  const GoalTracker& goals = parts_.goals;
  if (!goals.next() || !goals.goal() || now < onboard_.flight.time_nearest(goals.goal()->position)) return;
  parts_.goals.pass(now);
  append_tried_ = false;
}

/// Begins a decision cycle if it is time for a new goal.
void Exploration::choose() {
  const TimeNs now = onboard_.now();
  const Flight& flight = onboard_.flight;
  const MissionOptions& o = onboard_.options.mission;
  PathExecution& path = parts_.path;
  const GoalTracker& goals = parts_.goals;
  if (path.detour_due() && !flight.at_rest(now)) return begin_cycle(Joins::at_stop);
  const TimeNs rarely = onboard_.load.sheds(Relief::fewer_decisions) ? 2 : 1;
  if (now - last_cycle_ < rarely * kPause) return;
  if (flight.at_rest(now)) {
    path.take_no_detour();
    // The sensors observe this place before the next goal is chosen.
    const bool there =
        goals.goal() && !path.blocked() && (!steers() || reached(flight.reference(), *goals.goal()));
    return there ? reach_goal(now) : begin_cycle(Joins::at_stop);
  }
  if (path.blocked() || goals.next()) return;  // wait for the brake, or until the goal is passed
  if (goals.goal() && reached(flight.reference(), *goals.goal())) return reach_goal(now);
  if (goals.goal() && !goals.frontier_open()) return begin_cycle(Joins::at_stop);
  if (steers()) {
    // Plans end short of the goal: nothing can be appended, and the next goal is wanted in flight.
    if (!goals.goal() || now - last_cycle_ > rarely * kSteeredPeriod) begin_cycle(Joins::at_stop);
  } else if (flight.remaining_s(now) < append_before_s()) {
    // An appended path's speed limit applies from here on: do not append while the current path has one.
    if (o.append && !append_tried_ && !path.speed_limited()) begin_cycle(Joins::at_end);
    append_tried_ = true;
  } else if (now - last_cycle_ > rarely * from_seconds(o.decision_period_s)) {
    begin_cycle(Joins::at_stop);
  }
}

/// For a fast vehicle, before it brakes for the end of its path.
double Exploration::append_before_s() const {
  const MissionOptions& o = onboard_.options.mission;
  if (!by_trust(onboard_.options.motion)) return o.append_before_s;
  const double braking_s =
      onboard_.flight.reference().velocity_mps.norm() / onboard_.flight.limits().max_acceleration_mps2;
  return std::max(o.append_before_s, braking_s + o.decision_budget_s + seconds(kPause));
}

void Exploration::reach_goal(TimeNs now) {
  parts_.goals.close_goal(GoalFate::reached, "", now);
  last_cycle_ = now;
}

CycleInput Exploration::cycle_input(const RouteStart& start, Joins joins) {
  const Flight& flight = onboard_.flight;
  CycleInput input;
  input.now = onboard_.now();
  input.deadline = start.at;
  input.state = flight.expected(input.deadline);
  input.from = start.committed.points.back();
  const Vec3 velocity = flight.reference().velocity_mps;
  const double heading_rad = start.committed.heading_rad;
  input.direction =
      velocity.norm() > 0.2 ? velocity.normalized() : Vec3(std::cos(heading_rad), std::sin(heading_rad), 0);
  input.seconds_left = parts_.endurance.seconds_left(input.now);
  const auto& battery = parts_.endurance.battery();
  input.battery_fraction = battery ? battery->fraction_left : 1;  // a policy is promised a number
  input.battery_seconds_left = parts_.endurance.battery_seconds_left();
  input.mission_seconds_left = parts_.endurance.mission_seconds_left(input.now);
  input.flown_length_m = parts_.flown_path.length_m();
  input.flown_path = parts_.flown_path.points();
  input.flown_path.insert(input.flown_path.end(), start.committed.points.begin(),
                          start.committed.points.end());
  input.standing = flight.at_rest(input.now);
  input.appending = joins == Joins::at_end;
  parts_.goals.tell(input);
  input.teammates = wiring_.teammates();
  return input;
}

void Exploration::begin_cycle(Joins joins) {
  cycle_running_ = true;
  last_cycle_ = onboard_.now();
  const TimeNs budget = from_seconds(onboard_.options.mission.decision_budget_s);
  const TimeNs deadline = onboard_.now() + budget;
  const bool appending = joins == Joins::at_end;
  RouteStart start = appending ? parts_.path.start_at_end(deadline) : parts_.path.start_at_stop(deadline);
  const CycleInput input = cycle_input(start, joins);
  if (appending) start.passed = parts_.goals.goal();  // an appended path begins at a goal
  if (start.passed) start.max_cut_m = std::min(start.max_cut_m, start.passed->tolerance_m);
  onboard_.map.job(
      "decision", budget,
      [this, input, start](Explorer& explorer) {
        return decide(explorer, input, start, onboard_.options, onboard_.vehicle);
      },
      [this, input](const Cycle& cycle) { on_cycle(input, cycle.result, cycle.route); });
}

void Exploration::on_cycle(const CycleInput& input, const CycleResult& result, const Route& route) {
  cycle_running_ = false;
  record_cycle(input, result);
  const TimeNs now = onboard_.now();
  const bool at_rest = onboard_.flight.at_rest(now);
  PathExecution& path = parts_.path;
  if (!parts_.phases.in(Phase::explore) || (path.blocked() && !at_rest) || path.outdated(input.now)) return;
  if (input.appending && path.detour_due()) return;  // the map has closed what this was to follow
  if (result.goal || !at_rest) {
    idle_since_.reset();
  } else if (!idle_since_) {
    idle_since_ = now;
  }
  if (result.goal) return fly_to(input, result, route);
  if (input.appending) return;  // the policy is asked again on arrival
  if (result.outcome == Outcome::explored && at_rest && is_over(result)) {
    wiring_.go_home((result.out_of_time ? "" : "explored: ") + result.reason);
  } else if (result.outcome == Outcome::go_home) {
    wiring_.go_home("the policy asked for it: " + result.reason);
  } else if (path.blocked() && at_rest) {
    parts_.goals.close_goal(GoalFate::unreachable, result.reason, now);
    path.unblock();
  } else if (!result.rejected.empty() && !parts_.goals.goal()) {
    parts_.goals.refuse(result.rejected.front().goal);
  }
}

/// While the map settles, there may be no goal for a moment. No waiting brings battery or time back.
bool Exploration::is_over(const CycleResult& result) const {
  const TimeNs patience = from_seconds(onboard_.options.mission.explored_patience_s);
  return result.out_of_time || onboard_.now() - *idle_since_ >= patience;
}

void Exploration::fly_to(const CycleInput& input, const CycleResult& result, const Route& route) {
  const TimeNs now = onboard_.now();
  GoalTracker& goals = parts_.goals;
  PathExecution& path = parts_.path;
  const bool keeps_to_it = goals.is_under_way(*result.goal) && !input.appending;
  const bool at_rest = onboard_.flight.at_rest(now);
  if (keeps_to_it && !path.blocked() && !path.detour_due() && !(steers() && at_rest)) return;
  if (input.appending && goals.goal()) {
    goals.append(*result.goal, now);
  } else {
    goals.accept(*result.goal, now);
    append_tried_ = false;
  }
  wiring_.claim(*result.goal);
  // In flight the horizon turns to the new goal by itself: from where the reference is, no faster than it
  // can.
  if (steers() && !at_rest && !path.detour_due()) return;
  path.follow(route, now);
}

void Exploration::watch_progress() {
  const TimeNs now = onboard_.now();
  const Vec3& here = onboard_.flight.reference().position;
  if (!parts_.goals.goal()) return still_.restart(here, now);
  if (still_.still_for(here, now) < from_seconds(onboard_.options.mission.goal_timeout_s)) return;
  parts_.goals.close_goal(GoalFate::abandoned, "no progress towards it", now);
  parts_.goals.drop_next(GoalFate::superseded, "the goal before it was abandoned", now);
  parts_.path.stop(now);
}

void Exploration::record_cycle(const CycleInput& input, const CycleResult& result) {
  const TimeNs now = onboard_.now();
  Recorder& recorder = onboard_.recorder;
  recorder.decision_cost(now, result.decide_ms, result.plan_ms);
  recorder.write(now, event::Decision{.outcome = result.outcome,
                                      .policy = result.policy,
                                      .reason = result.reason,
                                      .goals = result.goals_proposed,
                                      .frontiers = result.frontiers.size(),
                                      .appending = input.appending});
  event::Frontiers offered;
  for (const FrontierCluster& c : result.frontiers)
    offered.clusters.push_back({c.id, c.centroid, c.unknown_cells});
  recorder.write(now, offered);
  if (!result.policy_failure.empty())
    recorder.write(now, event::Safety{SafetyAction::fallback, "the policy failed: " + result.policy_failure});
  for (const UnseenFrontier& u : result.unseen)
    recorder.write(now, event::Frontier{event::FrontierState::refused, u.id, u.position, u.reason});
  for (const RejectedGoal& r : result.rejected)
    recorder.write(now, goal_event(r.goal, event::GoalState::rejected, r.reason));
  for (const std::string& drawing : result.drawing_texts) recorder.write(now, event::Drawing::kKind, drawing);
  for (const std::string& text : result.log) recorder.write(now, event::Log{text});
}

}  // namespace karst::core
