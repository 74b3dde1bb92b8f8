// A trajectory of minimum-snap polynomials along a path: the comparison to the paper's sampling, after
// Richter, Bry and Roy (2016) and Burri et al. (2015), whom the paper compares with.
#pragma once
#include <functional>
#include <string>

#include "core_stack/planning/trajectory/minimum_snap.h"
#include "core_stack/planning/trajectory/trajectory.h"

namespace karst::core {

/// True if the map lets the vehicle fly straight from one point to the other.
using SegmentClear = std::function<bool(const Vec3&, const Vec3&)>;

struct PolynomialTrajectory {
  Trajectory trajectory;
  double speed_limit_mps = 0;  // it was made for
  std::size_t waypoints = 0;
  int rounds = 0;         // of optimization; more than one if waypoints had to be added for rock
  std::string fell_back;  // why it was sampled after all; empty: it is a polynomial
};

/// Along the corners of `points`, departing as given and ending at rest. Where the polynomial is not clear,
/// the path's middle between two waypoints becomes a waypoint and all is solved again; after some rounds, or
/// if the limits cannot be kept, the result is what sample_trajectory makes of `points`.
PolynomialTrajectory polynomial_trajectory(const std::vector<Vec3>& points, const Departure& departure,
                                           TimeNs start, const MotionLimits& limits,
                                           const HeadingPlan& heading, const SegmentClear& clear);

/// Indices of the points that a polyline within `tolerance_m` of all needs (Douglas and Peucker), and of more
/// between where they are farther apart along the path than `max_m`.
std::vector<std::size_t> corners(const std::vector<Vec3>& points, double tolerance_m, double max_m);

}  // namespace karst::core
