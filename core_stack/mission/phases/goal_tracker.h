// The goal under way and the one appended behind it; what became of the last; and what the policy has yet to
// be told of them.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core_stack/mission/onboard/explorer.h"
#include "core_stack/mission/recording/recorder.h"

namespace karst::core {

class GoalTracker {
 public:
  explicit GoalTracker(Recorder& recorder) : recorder_(recorder) {}

  const std::optional<Goal>& goal() const { return goal_; }
  const std::optional<Goal>& next() const { return next_; }
  /// Of the goal under way; 0: none.
  std::uint32_t frontier() const { return goal_ ? goal_->frontier_id : 0; }
  /// False once that frontier has been seen on the way to it.
  bool frontier_open() const { return frontier_open_; }
  /// The goal under way is this one, as far as it matters.
  bool is_under_way(const Goal& goal) const;

  /// The policy's new goal, flown to from now on. One under way is superseded, unless it is the same.
  void accept(const Goal& goal, TimeNs now);
  /// The same, flown to once the goal under way is reached.
  void append(const Goal& goal, TimeNs now);
  /// The goal under way is passed, and the appended one takes its place.
  void pass(TimeNs now);
  /// The goal under way came to its end. Nothing happens if there is none.
  void close_goal(GoalFate fate, const std::string& reason, TimeNs now);
  /// The appended goal is given up.
  void drop_next(GoalFate fate, const std::string& reason, TimeNs now);
  /// With no goal under way, one was proposed and refused.
  void refuse(const Goal& goal);
  /// What the map says of the frontier that was asked for.
  void note_frontier(std::uint32_t id, bool open);
  void note_homing(const std::string& reason, TimeNs now);

  /// What a round of decision has to know; what is told here is not told again.
  void tell(CycleInput& input);
  /// What the policy has yet to be told.
  std::vector<PolicyEvent> take_events();

 private:
  void report(const Goal& goal, GoalFate fate, const std::string& reason, TimeNs now);

  Recorder& recorder_;
  std::optional<Goal> goal_, next_, last_;
  GoalFate last_fate_ = GoalFate::none;
  bool frontier_open_ = true;
  std::vector<PolicyEvent> events_;
  std::vector<std::uint32_t> looked_at_;  // frontiers reached, or seen on the way
};

event::Goal goal_event(const Goal& goal, event::GoalState state, const std::string& reason);

}  // namespace karst::core
