// Minimum-snap piecewise polynomials through waypoints at given times, after Richter, Bry and Roy (2016): an
// unconstrained quadratic program whose unknowns are the derivatives at the waypoints.
//
// Pieces have degree 7. Between fixed times and positions the minimum-snap curve satisfies p^(8) = 0 (the
// Euler-Lagrange equation), and free derivatives at the joints make it continuous up to the sixth derivative.
// Pieces of degree 9, as in the article, would give the same curve.
#pragma once
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

/// One piece. Coefficients are in time / duration in [0, 1], the constant first, one column per axis.
struct PolynomialPiece {
  using Coefficients = Eigen::Matrix<double, 8, 3>;
  double duration_s = 0;
  Coefficients coefficients = Coefficients::Zero();

  /// The derivative of the position of that order, `t_s` after the piece's start.
  Vec3 at(double t_s, int order) const;
};

struct Polynomial {
  std::vector<PolynomialPiece> pieces;
  double snap_cost = 0;  // integral of the squared snap, m^2/s^7

  double duration_s() const;
  Vec3 at(double t_s, int order) const;  // clamped to the start and the end
};

struct Departure {
  Vec3 velocity_mps = Vec3::Zero(), acceleration_mps2 = Vec3::Zero();
};

/// The curve through `waypoints` (at least two) that departs as given and ends at rest, with zero velocity
/// and acceleration. Jerk at both ends is free, as the tracker only bounds it. Durations must be positive,
/// one fewer than waypoints.
Polynomial minimum_snap(const std::vector<Vec3>& waypoints, const std::vector<double>& durations_s,
                        const Departure& departure);

}  // namespace karst::core
