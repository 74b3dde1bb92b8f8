// Rounds the corners of a path, so that a vehicle that may accelerate across it need not slow down for them.
#pragma once
#include <vector>

#include "core_stack/planning/free_space/free_tiles.h"

namespace karst::core {

/// Moves each of `points` to the mean of itself and up to three points on either side, twice: with points
/// 0.1 m apart, a corner becomes an arc of about 1.2 m. Where a segment would be nearer to an obstacle than
/// `clearance_m`, fewer points count, and finally the point stays. Both ends stay.
std::vector<Vec3> round_corners(const FreeTiles& free, double clearance_m, const std::vector<Vec3>& points);

}  // namespace karst::core
