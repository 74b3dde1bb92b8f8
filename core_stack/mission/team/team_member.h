// A robot as a member of a team: its knowledge of the others, its landing sites, and its radio port. Mission
// control uses its Teamwork; the owner of the loop calls transmit() and receive() ten times a second.
#pragma once
#include <optional>

#include "core_stack/mission/options/mission_options.h"
#include "core_stack/team/teamwork.h"
#include "core_stack/vehicle/team_port.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

/// Settings shared by all members of a team.
struct TeamSetup {
  Vec3 base = Vec3::Zero();  // the base's antenna, world frame
  std::uint64_t seed = 1;
  MissionKey key;
};

/// A communication node that was dropped.
struct DroppedNode {
  RobotId id = 0;
  NodeDrop drop;
};

class TeamMember {
 public:
  /// `starts_at`: when the vehicle is switched on, in team time. The port must outlive the member.
  TeamMember(RobotId id, const CoreOptions& options, const VehicleDescription& vehicle,
             const TeamSetup& setup, TimeNs starts_at, TeamPort& port);

  void transmit(TimeNs team_time);
  void receive(TimeNs team_time);
  /// Drops a communication node if mission control has requested it since the last call.
  std::optional<DroppedNode> drop_due_node();

  RobotId id() const { return node_.self(); }
  const TeamNode& node() const { return node_; }
  Teamwork& teamwork() { return teamwork_; }

 private:
  TeamPort& port_;
  std::int64_t first_node_, nodes_dropped_ = 0;
  TeamNode node_;
  RelayHoming homing_;
  Teamwork teamwork_;
};

/// Sends the node's frames, or passes received frames to it.
void transmit(TeamNode& node, RadioPort& radio, TimeNs team_time);
void receive(TeamNode& node, RadioPort& radio, TimeNs team_time);

}  // namespace karst::core
