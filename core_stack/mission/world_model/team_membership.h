// Connects a vehicle's map to its team: the shared homing tree, the occupied cells it has yet to report, and
// the goals that other vehicles claim. A vehicle that flies alone claims and reports nothing.
//
// It runs on the map lane.
#pragma once
#include <span>
#include <vector>

#include "core_stack/team/relay_homing.h"

namespace karst::core {

/// Goals claimed by other vehicles. Frontiers within `radius_m` of them are left to these vehicles.
struct Claims {
  std::vector<Vec3> goals;
  double radius_m = 0;
  bool hold(const Vec3& frontier) const;
};

class TeamMembership {
 public:
  void join(RelayHoming* homing, double claim_radius_m) {
    homing_ = homing;
    claim_radius_m_ = claim_radius_m;
  }
  /// Null if the vehicle flies alone. Then only note() and claims() may be called.
  RelayHoming* homing() const { return homing_; }

  /// Stores the cells that became occupied until they are shared.
  void note(std::span<const CellChange> changes);
  /// Applies received facts and returns the facts to publish. The roadmap must be up to date.
  TreeFacts share(const VoxelMap& map, const Roadmap& roadmap, const Vec3& here, const TeamNews& news);
  Claims claims() const;

 private:
  RelayHoming* homing_ = nullptr;
  double claim_radius_m_ = 0;
  std::vector<CellKey> became_rock_;  // since the last share()
};

}  // namespace karst::core
