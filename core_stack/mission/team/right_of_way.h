// Right of way when vehicles meet: which goes first, and where the other makes room.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mission/phases/flown_path.h"
#include "core_stack/mission/phases/goal_tracker.h"
#include "core_stack/mission/phases/path_execution.h"
#include "core_stack/mission/phases/still_watch.h"
#include "core_stack/team/right_of_way/yield_state.h"
#include "core_stack/team/teamwork.h"

namespace karst::core {

/// The phase as reported to the team.
TeamPhase phase_for_team(Phase phase);

class RightOfWay {
 public:
  struct Parts {
    const PhaseMachine& phases;
    GoalTracker& goals;
    PathExecution& path;
    const FlownPath& flown_path;
  };
  RightOfWay(Onboard& onboard, Teamwork& team, const Parts& parts)
      : onboard_(onboard), team_(team), parts_(parts) {}

  /// Call ten times a second: stops the vehicle for another with the right of way, and makes room for it.
  void step();
  /// A limit where it may meet a vehicle that it does not hear.
  std::optional<double> max_speed_mps() const { return max_speed_mps_; }
  /// The phase to report now.
  TeamPhase phase_to_report() const;

 private:
  void note_arrival();
  void on_change(bool held, RobotId held_for);
  void look_out(const std::vector<Neighbour>& others);
  void note_failed(const Vec3& place);
  void make_room(const std::vector<Neighbour>& others);
  struct Room {
    std::optional<WaitingPlace> waiting_place;
    Route route;
  };
  Room find_room(Explorer& explorer, RoomQuery query, const RouteStart& start) const;
  void on_room(const Room& room, bool crowd);

  Onboard& onboard_;
  Teamwork& team_;
  Parts parts_;
  YieldState yield_state_;
  StillWatch still_;
  WaitingPlace waiting_place_;       // where it last made room
  std::vector<Vec3> failed_places_;  // it waited there for long, or in the other's way
  std::optional<double> max_speed_mps_;
  bool planning_ = false;
};

}  // namespace karst::core
