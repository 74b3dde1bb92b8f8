// A cave to ask policies about: winding passages that branch, known as far as they have been seen.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mapping/frontiers/frontiers.h"
#include "core_stack/mission/decision/viewpoints.h"
#include "core_stack/mission/policy/policy_port.h"

namespace karst::check {

struct CaveShape {
  double volume_m3 = 300;  // about
  double radius_m = 1.6;   // of a passage; it varies by a third
  int branches = 3;        // passages that begin somewhere in an earlier one
  double resolution_m = 0.2;
};

/// The map, the frontiers and the roadmap agree at all times, as in flight.
class Cave {
 public:
  Cave(std::uint64_t seed, const CaveShape& shape);

  /// Makes known what lies up to `way_m` along the passages. Walls of what is free are occupied, the rest is
  /// unknown. Never less than before.
  void reveal(double path_m);
  double length_m() const { return length_m_; }

  const core::VoxelMap& map() const { return map_; }
  const core::Roadmap& roadmap() const { return roadmap_; }
  double clearance_m() const { return planning_.clearance_m; }
  const core::Vec3& start() const { return balls_.front().center; }
  /// The middle of the passage furthest along it that is known.
  core::Vec3 front() const;

  /// As mission control offers them to a vehicle at `from`; they point into this object.
  std::vector<core::FrontierOffer> offers(const core::VehicleDescription& vehicle, const core::Vec3& from);

 private:
  struct Ball {
    core::Vec3 center;
    double radius_m, path_m;  // from the start, along the passages
  };
  void dig(std::uint64_t seed, const CaveShape& shape);
  template <class Visit>
  void for_each_cell(const Ball& ball, Visit&& visit) const;

  core::PlanningOptions planning_;
  core::VoxelMap rock_;  // free: dug
  core::VoxelMap map_;
  core::Frontiers frontiers_;
  core::Roadmap roadmap_;
  std::vector<Ball> balls_;  // by way_m
  std::size_t revealed_ = 0;
  double length_m_ = 0;
  std::map<std::uint32_t, std::optional<core::Viewpoint>> viewpoints_;  // since the last reveal
};

}  // namespace karst::check
