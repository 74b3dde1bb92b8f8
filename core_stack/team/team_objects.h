// Objects of interest known to a team: the reports of each finder, and the objects merged from them.
#pragma once
#include <map>
#include <utility>
#include <vector>

#include "core_stack/team/communication/messages.h"

namespace karst::core {

/// The last report of each finder under each of its numbers. Withdrawn objects stay, with kind 0, so that a
/// late report cannot restore them.
using ReportedObjects = std::map<std::pair<RobotId, std::uint32_t>, ObjectSeen>;

/// The later of two reports under one number holds.
void note(ReportedObjects& objects, RobotId finder, const ObjectSeen& seen);

struct TeamObject {
  std::uint8_t kind = 0;
  Vec3 position = Vec3::Zero();
  double deviation_m = 0;
  std::vector<std::pair<RobotId, std::uint32_t>> reported_by;  // keys of ReportedObjects
};

/// Merges reports of one kind by different finders into one object if they lie within 1 m plus three times
/// their combined deviation of each other, and within 3 m. Its position is their mean weighted by inverse
/// variance. Two reports of one finder are always two objects. The result does not depend on the order of
/// arrival.
std::vector<TeamObject> merged(const ReportedObjects& reports);

}  // namespace karst::core
