// How far into the cave a flight came, whatever detours and loops it made.
#pragma once
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::evaluation {

/// Greatest distance of a place of the flight from its first one, along the flown way with its detours cut
/// out: the shortest way over points a quarter of a metre apart, each linked to the next in time and to all
/// within 0.6 m. Two places so near were passed by a hull of 0.3 m radius, and the straight line between them
/// lies inside what the hull swept: no rock can be between. Metres; 0 without poses.
double depth_along_path(const std::vector<core::Vec3>& positions);

/// Greatest height above or below the first position, metres.
double vertical_reach(const std::vector<core::Vec3>& positions);

}  // namespace karst::evaluation
