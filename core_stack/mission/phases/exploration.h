// Exploration: decides when to ask the policy, and joins its goal to the current trajectory.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/mission/phases/endurance.h"
#include "core_stack/mission/phases/flown_path.h"
#include "core_stack/mission/phases/goal_tracker.h"
#include "core_stack/mission/phases/path_execution.h"
#include "core_stack/mission/phases/still_watch.h"

namespace karst::core {

class Exploration {
 public:
  struct Wiring {
    std::function<void(const std::string& reason)> go_home;
    std::function<void(const Goal&)> claim;                 // claims an accepted goal in the team
    std::function<std::vector<TeammateState>()> teammates;  // empty without a team
  };
  struct Parts {
    const PhaseMachine& phases;
    GoalTracker& goals;
    PathExecution& path;
    const FlownPath& flown_path;
    const Endurance& endurance;
  };
  Exploration(Onboard& onboard, const Parts& parts, Wiring wiring)
      : onboard_(onboard), parts_(parts), wiring_(std::move(wiring)) {}

  void begin();
  /// Call ten times a second.
  void step();

 private:
  enum class Joins { at_stop, at_end };  // where the vehicle can stop, or at the end of the current path
  /// Whether motion is replanned with a receding horizon (Steering).
  bool steers() const { return onboard_.options.motion.trajectory == TrajectoryKind::horizon; }
  void pass_goal();
  void choose();
  void begin_cycle(Joins joins);
  CycleInput cycle_input(const RouteStart& start, Joins joins);
  void on_cycle(const CycleInput& input, const CycleResult& result, const Route& route);
  void fly_to(const CycleInput& input, const CycleResult& result, const Route& route);
  void record_cycle(const CycleInput& input, const CycleResult& result);
  void watch_progress();
  void reach_goal(TimeNs now);
  double append_before_s() const;
  /// Whether `explored`, the answer to a vehicle at rest, is believed.
  bool is_over(const CycleResult& result) const;

  Onboard& onboard_;
  Parts parts_;
  Wiring wiring_;
  StillWatch still_;
  bool cycle_running_ = false;
  bool append_tried_ = false;  // to the current goal
  TimeNs last_cycle_ = 0;
  std::optional<TimeNs> idle_since_;  // at rest, and no answer since then has had a goal
};

}  // namespace karst::core
