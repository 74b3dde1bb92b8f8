// Tracks the current goal, the goal appended to it, the fate of the last one, and the events that the policy
// has yet to receive.
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
  /// The current goal's frontier; 0: none.
  std::uint32_t frontier() const { return goal_ ? goal_->frontier_id : 0; }
  /// False once that frontier has been seen from afar.
  bool frontier_open() const { return frontier_open_; }
  /// Whether `goal` is practically the same as the current goal.
  bool is_under_way(const Goal& goal) const;

  /// Makes `goal` the current goal. A previous one is superseded, unless it is the same.
  void accept(const Goal& goal, TimeNs now);
  /// Appends a goal that becomes current once the current one is reached.
  void append(const Goal& goal, TimeNs now);
  /// Closes the current goal as passed and makes the appended one current.
  void pass(TimeNs now);
  /// Closes the current goal with this fate. Does nothing if there is none.
  void close_goal(GoalFate fate, const std::string& reason, TimeNs now);
  /// Drops the appended goal.
  void drop_next(GoalFate fate, const std::string& reason, TimeNs now);
  /// Notes a refused goal when there is no current one.
  void refuse(const Goal& goal);
  /// Notes whether a frontier is still open in the map.
  void note_frontier(std::uint32_t id, bool open);
  void note_homing(const std::string& reason, TimeNs now);

  /// Fills in a decision cycle's input. Events and frontiers are passed on only once.
  void tell(CycleInput& input);
  /// The events that the policy has yet to receive.
  std::vector<PolicyEvent> take_events();

 private:
  void report(const Goal& goal, GoalFate fate, const std::string& reason, TimeNs now);

  Recorder& recorder_;
  std::optional<Goal> goal_, next_, last_;
  GoalFate last_fate_ = GoalFate::none;
  bool frontier_open_ = true;
  std::vector<PolicyEvent> events_;
  std::vector<std::uint32_t> looked_at_;  // frontiers reached or seen in passing
};

event::Goal goal_event(const Goal& goal, event::GoalState state, const std::string& reason);

}  // namespace karst::core
