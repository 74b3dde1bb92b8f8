#include "core_stack/team/communication/plausible.h"

#include <algorithm>

namespace karst::core {
namespace {

bool said(const TeamRadio& team, RobotId author, const TreeFacts& facts, TimeNs latest) {
  const auto member = [&team](const NodeId& id) { return team.is_member(id.robot); };
  return std::all_of(facts.nodes.begin(), facts.nodes.end(),
                     [&](const TreeNode& n) { return n.id.robot == author; }) &&
         std::all_of(facts.rays.begin(), facts.rays.end(),
                     [&](const RayFact& r) { return member(r.a) && member(r.b) && r.stamp <= latest; }) &&
         std::all_of(facts.lives.begin(), facts.lives.end(),
                     [&](const LifeFact& l) { return member(l.id) && l.stamp <= latest; });
}
bool said(const TeamRadio& team, RobotId author, const GoalClaim& goal, TimeNs latest) {
  return team.is_robot(author) && goal.stamp <= latest;
}
bool said(const TeamRadio&, RobotId author, const LandingClaim& landing, TimeNs latest) {
  return author != kBase && landing.stamp <= latest;
}
bool said(const TeamRadio&, RobotId, const ObjectSeen& object, TimeNs latest) {
  return object.stamp <= latest;
}
bool said(const TeamRadio&, RobotId author, const Receipt&, TimeNs) { return author == kBase; }

}  // namespace

bool plausible(const TeamRadio& team, const TeamState& state, TimeNs now) {
  return team.is_member(state.robot) && state.stamp <= now + kClockTolerance &&
         (team.is_robot(state.robot) || !in_the_air(state.phase));
}

bool plausible(const TeamRadio& team, RobotId author, const Record& record, TimeNs now) {
  return team.is_member(author) &&
         std::visit([&](const auto& r) { return said(team, author, r, now + kClockTolerance); }, record);
}

}  // namespace karst::core
