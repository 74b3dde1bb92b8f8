// A vehicle's exchange with its team: it reports its position, its goals and its findings, receives those of
// the others, and drops communication nodes.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mapping/occupancy/moving_bodies.h"
#include "core_stack/mission/onboard/onboard.h"
#include "core_stack/mission/phases/endurance.h"
#include "core_stack/mission/phases/path_execution.h"
#include "core_stack/mission/state/phase.h"
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

  /// Call ten times a second.
  void report(TeamPhase phase);
  /// Call once a second in the air: applies what was received, publishes new findings, and drops a node
  /// before the others go out of range.
  void share();
  void claim_goal(const Goal& goal);
  void give_up_goals();
  /// Turns a landed vehicle into a relay. Call it when no job runs on the map lane. `landed_below`: the hover
  /// above where it stands.
  void become_relay(bool stands, const std::optional<Vec3>& landed_below);

  /// No other vehicle is near the place where it hovers first, or comes home to land near it.
  bool airspace_clear() const;
  /// Whether another vehicle flies near, which may block the path briefly.
  bool in_company() const;
  /// The moving vehicles' positions at `stamp`. Vehicles that stand, aside or landed, are left out: they are
  /// obstacles in the map.
  std::vector<MovingBody> others_at(TimeNs stamp) const;
  std::vector<TeammateState> teammates() const { return team_.teammates(onboard_.now()); }

 private:
  void drop_node(const NodeDrop& drop);
  bool may_drop() const;

  Onboard& onboard_;
  Teamwork& team_;
  Parts parts_;
  std::int64_t nodes_left_;  // on board
  std::optional<TimeNs> dropped_at_;
};

}  // namespace karst::core
