// A synthetic cave for testing policies: winding passages that branch, known as far as they have been seen.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mapping/frontiers/frontiers.h"
#include "core_stack/mission/decision/viewpoints.h"
#include "core_stack/mission/policy/policy_port.h"

namespace karst::check {

struct CaveShape {
  double volume_m3 = 300;  // approximate
  double radius_m = 1.6;   // of a passage; it varies by a third
  int branches = 3;        // passages that begin at a point of an earlier one
  double resolution_m = 0.2;
};

/// The map, the frontiers and the roadmap are always consistent, as in flight.
class Cave {
 public:
  Cave(std::uint64_t seed, const CaveShape& shape);

  /// Reveals the cave up to `path_m` along the passages. Walls beside free space are occupied, the rest is
  /// unknown. Never reveals less than before.
  void reveal(double path_m);
  double length_m() const { return length_m_; }

  const core::VoxelMap& map() const { return map_; }
  const core::Roadmap& roadmap() const { return roadmap_; }
  double clearance_m() const { return planning_.clearance_m; }
  const core::Vec3& start() const { return balls_.front().center; }
  /// The centre of the passage at its farthest known point. World frame.
  core::Vec3 front() const;

  /// Frontier offers as mission control makes them at `from` (world frame); they point into this object.
  std::vector<core::FrontierOffer> offers(const core::VehicleDescription& vehicle, const core::Vec3& from);

 private:
  struct Ball {
    core::Vec3 center;
    double radius_m, path_m;  // path_m: from the start, along the passages
  };
  void dig(std::uint64_t seed, const CaveShape& shape);
  template <class Visit>
  void for_each_cell(const Ball& ball, Visit&& visit) const;

  core::PlanningOptions planning_;
  core::VoxelMap rock_;  // free where a passage was dug
  core::VoxelMap map_;
  core::Frontiers frontiers_;
  core::Roadmap roadmap_;
  std::vector<Ball> balls_;  // by path_m
  std::size_t revealed_ = 0;
  double length_m_ = 0;
  std::map<std::uint32_t, std::optional<core::Viewpoint>> viewpoints_;  // since the last reveal
};

}  // namespace karst::check
