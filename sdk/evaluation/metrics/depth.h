// How far into the cave a flight advanced, independent of detours and loops.
#pragma once
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::evaluation {

/// Greatest distance of a point of the flight from its first one, along the flown path without its detours:
/// the shortest path over points a quarter of a metre apart, each linked to the next in time and to all
/// within 0.6 m. A hull of 0.3 m radius passed both of two points that near, and the straight line between
/// them lies inside the volume it swept, which is free of rock. Metres; 0 without poses.
double depth_along_path(const std::vector<core::Vec3>& positions);

/// Greatest height above or below the first position, in metres.
double vertical_reach(const std::vector<core::Vec3>& positions);

}  // namespace karst::evaluation
