// Finds where a vehicle that must land at once can descend: straight below, or a few metres away.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// Asked while the vehicle flies, so that the answer is at hand when it is needed.
struct DescentQuery {
  Vec3 from = Vec3::Zero();  // where it would stop
  /// The flown path, from `from` back: poses that the vehicle has passed without contact.
  std::vector<Vec3> flown_back;
  double vehicle_radius_m = 0.3;
  /// The hover above its intended landing site, if it has one.
  std::optional<Vec3> landing_hover;
};

/// The path from `from` to a place above ground that the vehicle can stand on: to `landing_hover` if that is
/// near and in line of sight; `from` alone if there is such ground below it; else along a clear straight
/// line; else back along the flown path. The ground may be steeper than that of a regular landing site, but
/// not so steep that the vehicle slides or topples. Empty if no such ground is known.
std::vector<Vec3> descent_path(const VoxelMap& map, const DescentQuery& query);

}  // namespace karst::core
