// Steering: while the vehicle explores, it plans the next three seconds five times a second, and looks at
// what is unknown on its way to the goal.
#pragma once
#include <optional>

#include "core_stack/mission/phases/goal_tracker.h"
#include "core_stack/mission/phases/path_execution.h"
#include "core_stack/mission/state/seen_with.h"

namespace karst::core {

class Steering {
 public:
  struct Parts {
    const PhaseMachine& phases;
    const GoalTracker& goals;
    PathExecution& path;
  };
  Steering(Onboard& onboard, const Parts& parts) : onboard_(onboard), parts_(parts) {}

  /// Call when the map has changed: what was seen then changes the course soonest.
  void on_map(SeenWith sensor);

 private:
  bool begins_plans(SeenWith sensor) const;
  bool applies() const;
  bool goal_waits() const;
  /// A LiDAR sees all around: there is nothing to turn for on the way.
  bool turns() const { return !onboard_.vehicle.lidar; }
  void note_goal();
  MotionLimits limits(const Goal& goal) const;
  HorizonQuery query(TimeNs at) const;
  void on_plan(const std::optional<HorizonPlan>& plan, TimeNs begun);

  Onboard& onboard_;
  Parts parts_;
  std::optional<Vec3> goal_;  // under way
  TimeNs goal_since_ = 0;
  Vec3 asked_goal_ = Vec3::Zero();  // of the plan that is being made
  MotionLimits asked_limits_;       // the same
  std::optional<double> direct_s_;  // the time to the goal when it was first planned for
  std::optional<Legs> legs_;        // of the last plan
  TimeNs legs_begin_ = 0;
  TimeNs last_ = 0;
  TimeNs last_scan_ = 0;
  bool planning_ = false;
};

}  // namespace karst::core
