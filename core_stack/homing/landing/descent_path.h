// Where a vehicle that has to land at once can come down: straight below, or a few metres away.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// What is asked while the vehicle flies, so that the answer is there when it is needed.
struct DescentQuery {
  Vec3 from = Vec3::Zero();  // where it would stop
  /// The way it came, from `from` back: poses that were flown without touching anything.
  std::vector<Vec3> flown_back;
  double vehicle_radius_m = 0.3;
  /// The hover above where it is to land anyway, if it has come to hover.
  std::optional<Vec3> landing_hover;
};

/// From `from` to above ground that the vehicle can stand on: to `landing_hover` if that is near and in
/// sight; `from` alone if there is such ground below it; else along a clear straight line; else back along
/// the way flown. The ground may be steeper than a chosen landing place is, but less so than a vehicle slides
/// or topples. Empty: no such ground is known.
std::vector<Vec3> descent_path(const VoxelMap& map, const DescentQuery& query);

}  // namespace karst::core
