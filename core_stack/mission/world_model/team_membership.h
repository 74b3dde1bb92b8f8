// What ties a vehicle's map to its team: the homing tree it shares, the rock it has yet to report, and the
// goals that other vehicles claim. Alone, a vehicle claims and reports nothing.
//
// It lives on the map lane.
#pragma once
#include <span>
#include <vector>

#include "core_stack/team/relay_homing.h"

namespace karst::core {

/// Frontiers within `radius_m` of `goals` are left to the vehicles that claim these.
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
  /// Null: it flies alone. The members below are then not called, but for note and claims.
  RelayHoming* homing() const { return homing_; }

  /// Keeps the cells that became rock until they are shared.
  void note(std::span<const CellChange> changes);
  /// Takes in what was heard; returns what to report. The roadmap must be up to date.
  TreeFacts share(const VoxelMap& map, const Roadmap& roadmap, const Vec3& here, const TeamNews& news);
  Claims claims() const;

 private:
  RelayHoming* homing_ = nullptr;
  double claim_radius_m_ = 0;
  std::vector<CellKey> became_rock_;  // since the team was last told
};

}  // namespace karst::core
