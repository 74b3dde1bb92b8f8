// What a vehicle does because it is one of a team: it tells the others where it is, what it explores and what
// it finds, takes in what they tell, and drops communication nodes behind it.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mapping/occupancy/moving_bodies.h"
#include "core_stack/mission/onboard/onboard.h"
#include "core_stack/mission/phases/endurance.h"
#include "core_stack/mission/phases/path_execution.h"
#include "core_stack/mission/phases/phase.h"
#include "core_stack/team/teamwork.h"

namespace karst::core {

class TeamSharing {
 public:
  struct Parts {
    const PhaseMachine& phases;
    const PathExecution& path;
    const Endurance& endurance;
  };
  TeamSharing(Onboard& onboard, Teamwork& team, const Parts& parts)
      : onboard_(onboard), team_(team), parts_(parts), nodes_left_(team.options().nodes) {}

  /// Ten times a second.
  void report(TeamPhase phase);
  /// Once a second in the air: takes in what was heard, tells what was found since, and drops a node where
  /// the others would be out of reach next.
  void share();
  void claim_goal(const Goal& goal);
  void give_up_goals();
  /// On the ground, for good. Called when nothing runs on the map lane any more. `hover`: above where it
  /// stands.
  void become_relay(bool stands, const std::optional<Vec3>& landed_below);

  /// No other vehicle is near the place where it hovers first, or comes home to land near it.
  bool airspace_clear() const;
  /// Another flies near: what is in the way may be gone in a moment.
  bool in_company() const;
  /// Where the others are that move, at `stamp`: those that stand, aside or landed, are obstacles like any
  /// other.
  std::vector<MovingBody> others_at(TimeNs stamp) const;
  std::vector<TeammateState> teammates() const { return team_.teammates(onboard_.now()); }

 private:
  void drop_node(const NodeDrop& drop);
  bool may_drop() const;

  Onboard& onboard_;
  Teamwork& team_;
  Parts parts_;
  std::int64_t nodes_left_;  // that it carries
  std::optional<TimeNs> dropped_at_;
};

}  // namespace karst::core
