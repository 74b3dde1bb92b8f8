// The escape path from a position that is nearer to an obstacle than the clearance, because the map has
// changed or the vehicle was pushed there.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/planning/free_space/free_tiles.h"

namespace karst::core {

/// The shortest path from `start`, which must lie in a free cell, to the centre of a clear cell within about
/// two clearances. It leads through free cells whose distance to the nearest obstacle never decreases. It
/// begins with `start`. Nothing if there is none. From outside the map's region it is the way back inside.
std::optional<std::vector<Vec3>> escape_path(const VoxelMap& map, FreeTiles& free, const Vec3& start,
                                             double clearance_m);

/// A path at most 1.2 times as long as the shortest from `start`, in a free cell outside the map's region, to
/// the centre of a clear cell inside, at most 15 m long. All of it keeps the clearance from rock and unknown
/// cells, or as much as `start` has. It begins with `start`. Nothing if there is none, or if `max_cells`
/// visited do not suffice.
std::optional<std::vector<Vec3>> path_back_inside(const VoxelMap& map, FreeTiles& free, const Vec3& start,
                                                  double clearance_m, std::size_t max_cells = 10'000);

}  // namespace karst::core
