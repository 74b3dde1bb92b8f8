// What a team's member cannot have said truly, whoever says so. Frames are authenticated (mission_key.h);
// these rules hold for frames with a valid tag, too: a member whose software or clock is wrong costs nobody a
// vehicle.
#pragma once
#include "core_stack/team/communication/messages.h"
#include "core_stack/team/communication/mission_key.h"

namespace karst::core {

/// One of a team's radios. Number 0 is the base's, 1 to `robots` are the robots', then come the nodes' that
/// they drop.
struct TeamRadio {
  RobotId self = 0;
  RobotId robots = kMaxRobots - 1, nodes = 0;  // nodes of each
  MissionKey key{};

  int radios() const { return 1 + robots * (1 + nodes); }
  bool is_member(RobotId id) const { return id < radios(); }
  bool is_robot(RobotId id) const { return id != kBase && id <= robots; }
};

/// What is said of a later time would stand in the way of all that follows. The team's clocks are set
/// together before the mission; in an hour quartz of 20 ppm strays by 0.07 s.
constexpr TimeNs kClockTolerance = 250 * kMillisecond;

/// A member's, not of the future, and only robots fly.
bool plausible(const TeamRadio& team, const TeamState& state, TimeNs now);
/// Of members, not of the future; nodes of the tree are made by their author, goals claimed by robots, and
/// receipts given by the base.
bool plausible(const TeamRadio& team, RobotId author, const Record& record, TimeNs now);

}  // namespace karst::core
