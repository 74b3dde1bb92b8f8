#include "core_stack/mission/phases/goal_tracker.h"

#include <cmath>
#include <utility>

namespace karst::core {
namespace {

constexpr double kSameGoal_m = 0.3;

struct FateEvent {
  PolicyEvent::Kind kind;
  event::GoalState state;
};

/// How a goal's fate appears in the policy's events and in the run's events.
FateEvent event_of(GoalFate fate) {
  switch (fate) {
    case GoalFate::reached:
      return {PolicyEvent::Kind::goal_reached, event::GoalState::reached};
    case GoalFate::unreachable:
      return {PolicyEvent::Kind::goal_unreachable, event::GoalState::unreachable};
    case GoalFate::abandoned:
      return {PolicyEvent::Kind::goal_abandoned, event::GoalState::abandoned};
    case GoalFate::superseded:
      return {PolicyEvent::Kind::goal_superseded, event::GoalState::superseded};
    case GoalFate::rejected:
    case GoalFate::none:
    case GoalFate::under_way:
      break;
  }
  return {PolicyEvent::Kind::goal_rejected, event::GoalState::rejected};
}

}  // namespace

event::Goal goal_event(const Goal& goal, event::GoalState state, const std::string& reason) {
  return {state, goal.position, goal.heading_rad, goal.score, goal.frontier_id, goal.why, reason};
}

bool GoalTracker::is_under_way(const Goal& goal) const {
  return goal_ && (goal_->position - goal.position).norm() < kSameGoal_m;
}

void GoalTracker::accept(const Goal& goal, TimeNs now) {
  recorder_.write(now, goal_event(goal, event::GoalState::accepted, ""));
  if (!is_under_way(goal))
    close_goal(GoalFate::superseded,
               frontier_open_ ? "the policy chose another" : "its frontier has been seen", now);
  goal_ = goal;
  frontier_open_ = true;
}

void GoalTracker::append(const Goal& goal, TimeNs now) {
  recorder_.write(now, goal_event(goal, event::GoalState::accepted, ""));
  next_ = goal;
  frontier_open_ = true;
}

void GoalTracker::pass(TimeNs now) {
  close_goal(GoalFate::reached, "passed on the way to the next", now);
  goal_ = std::exchange(next_, std::nullopt);
}

void GoalTracker::report(const Goal& goal, GoalFate fate, const std::string& reason, TimeNs now) {
  const FateEvent how = event_of(fate);
  recorder_.write(now, goal_event(goal, how.state, reason));
  events_.push_back({how.kind, now, goal, reason});
}

void GoalTracker::close_goal(GoalFate fate, const std::string& reason, TimeNs now) {
  if (!goal_) return;
  report(*goal_, fate, reason, now);
  if (goal_->frontier_id != 0 && (fate == GoalFate::reached || !frontier_open_))
    looked_at_.push_back(goal_->frontier_id);
  last_fate_ = fate;
  last_ = std::exchange(goal_, std::nullopt);
}

void GoalTracker::drop_next(GoalFate fate, const std::string& reason, TimeNs now) {
  if (!next_) return;
  report(*next_, fate, reason, now);
  next_.reset();
}

void GoalTracker::refuse(const Goal& goal) {
  last_fate_ = GoalFate::rejected;
  last_ = goal;
}

void GoalTracker::note_frontier(std::uint32_t id, bool open) {
  const bool of_this_goal = goal_ && goal_->frontier_id == id;
  frontier_open_ = open || !of_this_goal;
}

void GoalTracker::note_homing(const std::string& reason, TimeNs now) {
  events_.push_back({PolicyEvent::Kind::homing, now, {}, reason});
}

void GoalTracker::tell(CycleInput& input) {
  input.last_fate = goal_ ? GoalFate::under_way : last_fate_;
  input.last_goal = goal_ ? goal_ : last_;
  input.events = take_events();
  input.looked_at = std::exchange(looked_at_, {});
}

std::vector<PolicyEvent> GoalTracker::take_events() { return std::exchange(events_, {}); }

}  // namespace karst::core
