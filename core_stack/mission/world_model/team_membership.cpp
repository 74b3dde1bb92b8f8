#include "core_stack/mission/world_model/team_membership.h"

#include <algorithm>
#include <utility>

namespace karst::core {

bool Claims::hold(const Vec3& frontier) const {
  return std::any_of(goals.begin(), goals.end(),
                     [&](const Vec3& g) { return (g - frontier).norm() < radius_m; });
}

void TeamMembership::note(std::span<const CellChange> changes) {
  if (!homing_) return;
  for (const CellChange& c : changes)
    if (c.after == Cell::occupied) became_rock_.push_back(c.key);
}

TreeFacts TeamMembership::share(const VoxelMap& map, const Roadmap& roadmap, const Vec3& here,
                                const TeamNews& news) {
  return homing_->update(map, roadmap, here, news, std::exchange(became_rock_, {}));
}

Claims TeamMembership::claims() const {
  return homing_ ? Claims{homing_->others_goals(), claim_radius_m_} : Claims{};
}

}  // namespace karst::core
