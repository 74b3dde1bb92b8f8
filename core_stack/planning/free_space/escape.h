// The way out of a place that is nearer to an obstacle than the clearance: the map changed, or the vehicle
// was pushed there.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/planning/free_space/free_tiles.h"

namespace karst::core {

/// From `start`, which lies in a free cell, through free cells whose distance to the nearest obstacle never
/// shrinks, to the first clear cell's centre: the shortest such way within about two clearances. It begins
/// with `start`. Nothing if there is none.
std::optional<std::vector<Vec3>> escape_path(const VoxelMap& map, FreeTiles& free, const Vec3& start,
                                             double clearance_m);

}  // namespace karst::core
