// Plausibility checks of received messages. Frames are authenticated (mission_key.h); these rules also apply
// to frames with a valid tag, so that a member with faulty software or a wrong clock endangers no other
// vehicle.
#pragma once
#include "core_stack/team/communication/messages.h"
#include "core_stack/team/communication/mission_key.h"

namespace karst::core {

/// One of a team's radios. Number 0 is the base, 1 to `robots` are the robots, and the nodes that they drop
/// follow.
struct TeamRadio {
  RobotId self = 0;
  RobotId robots = kMaxRobots - 1, nodes = 0;  // nodes of each
  MissionKey key{};

  int radios() const { return 1 + robots * (1 + nodes); }
  bool is_member(RobotId id) const { return id < radios(); }
  bool is_robot(RobotId id) const { return id != kBase && id <= robots; }
};

/// A message stamped in the future would block all later ones, since newer messages replace older ones. The
/// team's clocks are synchronized before the mission; a 20 ppm quartz drifts by 0.07 s an hour.
constexpr TimeNs kClockTolerance = 250 * kMillisecond;

/// The sender is a member, the stamp is not in the future, and only robots fly.
bool plausible(const TeamRadio& team, const TeamState& state, TimeNs now);
/// The author is a member, and the stamp is not in the future. Authors publish only tree nodes of their own,
/// only robots claim goals, and only the base gives receipts.
bool plausible(const TeamRadio& team, RobotId author, const Record& record, TimeNs now);

}  // namespace karst::core
