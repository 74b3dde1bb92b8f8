// Objects of interest as a team knows them: what each finder told, and what that comes to together.
#pragma once
#include <map>
#include <utility>
#include <vector>

#include "core_stack/team/communication/messages.h"

namespace karst::core {

/// By finder and the finder's own number: what it told last. Those taken back stay, with kind 0, so that what
/// is late cannot bring them back.
using ReportedObjects = std::map<std::pair<RobotId, std::uint32_t>, ObjectSeen>;

/// Of two reports under one number the later holds.
void note(ReportedObjects& objects, RobotId finder, const ObjectSeen& seen);

struct TeamObject {
  std::uint8_t kind = 0;
  Vec3 position = Vec3::Zero();
  double deviation_m = 0;
  std::vector<std::pair<RobotId, std::uint32_t>> reported_by;  // keys of ReportedObjects
};

/// Reports of different finders about one kind are one object if they are nearer to each other than 1 m and
/// three times what both may be off by, and no more than 3 m: the average, weighted by the inverse squares of
/// the deviations. Two of one finder are two objects. A function of the reports, not of their order of
/// arrival.
std::vector<TeamObject> merged(const ReportedObjects& reports);

}  // namespace karst::core
