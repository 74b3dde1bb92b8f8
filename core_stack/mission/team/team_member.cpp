#include "core_stack/mission/team/team_member.h"

namespace karst::core {

void transmit(TeamNode& node, RadioPort& radio, TimeNs team_time) {
  for (const Bytes& frame : node.transmit(team_time)) radio.send(frame, team_time);
}

void receive(TeamNode& node, RadioPort& radio, TimeNs team_time) {
  for (const auto& frame : radio.receive(team_time)) node.receive(frame, team_time);
}

TeamMember::TeamMember(RobotId id, const CoreOptions& options, const VehicleDescription& vehicle,
                       const TeamSetup& setup, TimeNs starts_at, TeamPort& port)
    : port_(port),
      first_node_(options.team.robots + (id - 1) * options.team.nodes + 1),
      node_(id, options.team, options.homing, setup.base, setup.seed, setup.key),
      homing_(id, {.team = options.team,
                   .homing = options.homing,
                   .planning = options.planning,
                   .motion = options.motion,
                   .vehicle_radius_m = vehicle.radius_m,
                   .base = setup.base}),
      teamwork_(node_, homing_, options.team, starts_at) {
  TeamState waiting;
  waiting.position = vehicle.T_world_start.position;
  teamwork_.report(waiting, -starts_at);
}

void TeamMember::transmit(TimeNs team_time) { core::transmit(node_, port_, team_time); }
void TeamMember::receive(TimeNs team_time) { core::receive(node_, port_, team_time); }

std::optional<DroppedNode> TeamMember::drop_due_node() {
  const std::optional<NodeDrop> drop = teamwork_.take_drop();
  if (!drop) return std::nullopt;
  const auto id = static_cast<RobotId>(first_node_ + nodes_dropped_++);
  port_.drop_node(id);
  return DroppedNode{id, *drop};
}

}  // namespace karst::core
