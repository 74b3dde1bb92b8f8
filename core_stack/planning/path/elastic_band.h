// A path as an elastic band (Quinlan and Khatib, 1993): bending and tension smooth it, obstacles push it
// away.
#pragma once
#include <vector>

#include "core_stack/planning/free_space/free_tiles.h"

namespace karst::core {

/// Moves the inner points until they converge. Obstacles repel up to `preferred_m`. A point or segment with
/// clearance `clearance_m` keeps it; one without never comes nearer to obstacles.
std::vector<Vec3> smooth_band(const FreeTiles& free, double clearance_m, double preferred_m,
                              std::vector<Vec3> points);

/// A Catmull-Rom curve through the points, sampled at most `spacing_m` apart; pieces that would not be clear
/// stay straight.
std::vector<Vec3> fine_curve(const FreeTiles& free, double clearance_m, const std::vector<Vec3>& points,
                             double spacing_m);

}  // namespace karst::core
