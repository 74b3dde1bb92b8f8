// A trajectory of minimum-snap polynomials along a path, after Richter, Bry and Roy (2016) and Burri et al.
// (2015): the method that the paper compares its sampling with.
#pragma once
#include <functional>
#include <string>

#include "core_stack/planning/trajectory/minimum_snap.h"
#include "core_stack/planning/trajectory/trajectory.h"

namespace karst::core {

/// Whether the straight segment between two points is clear in the map.
using SegmentClear = std::function<bool(const Vec3&, const Vec3&)>;

struct PolynomialTrajectory {
  Trajectory trajectory;
  double speed_limit_mps = 0;  // the limit it was computed for
  std::size_t waypoints = 0;
  int rounds = 0;         // optimization rounds; more than one if waypoints were added near rock
  std::string fell_back;  // why it was sampled instead; empty: it is a polynomial
};

/// Computes the trajectory along the corners of `points`, departing as given and ending at rest. Where the
/// polynomial is not clear, the path's midpoint between two waypoints is added as a waypoint and the problem
/// is solved again. After some rounds, or if the limits cannot be kept, it falls back to sample_trajectory.
PolynomialTrajectory polynomial_trajectory(const std::vector<Vec3>& points, const Departure& departure,
                                           TimeNs start, const MotionLimits& limits,
                                           const HeadingPlan& heading, const SegmentClear& clear);

/// Indices of the points of a polyline within `tolerance_m` of all points (Douglas and Peucker), with further
/// points in between so that none are farther apart along the path than `max_m`.
std::vector<std::size_t> corners(const std::vector<Vec3>& points, double tolerance_m, double max_m);

}  // namespace karst::core
