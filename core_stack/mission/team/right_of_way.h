// Two vehicles meet: who goes first, and where the other makes room.
#pragma once
#include <vector>

#include "core_stack/mission/flight/path_execution.h"
#include "core_stack/mission/phases/goal_tracker.h"
#include "core_stack/mission/phases/way_flown.h"
#include "core_stack/mission/team/teamwork.h"
#include "core_stack/team/right_of_way/encounter.h"

namespace karst::core {

/// What the others are told of a phase.
TeamPhase told(Phase phase);

class RightOfWay {
 public:
  struct Parts {
    const PhaseMachine& phases;
    GoalTracker& goals;
    PathExecution& path;
    const WayFlown& way_flown;
  };
  RightOfWay(Onboard& onboard, Teamwork& team, const Parts& parts)
      : onboard_(onboard), team_(team), parts_(parts) {}

  /// Ten times a second: stops the vehicle for another that goes first, and has it make room.
  void step();
  /// What to tell of itself.
  TeamPhase told_now() const;

 private:
  void note_arrival();
  void on_change(bool held, RobotId held_for);
  void make_room(const std::vector<Neighbour>& others);
  struct Room {
    std::optional<Refuge> refuge;
    Route route;
  };
  Room find_room(Explorer& explorer, RoomQuery query, const RouteStart& start) const;
  void on_room(const Room& room, TimeNs begun, bool crowd);

  Onboard& onboard_;
  Teamwork& team_;
  Parts parts_;
  Encounter encounter_;
  Refuge refuge_;                      // where it last made room
  std::vector<Vec3> refuges_in_vain_;  // the other did not get by there
  bool planning_ = false;
};

}  // namespace karst::core
