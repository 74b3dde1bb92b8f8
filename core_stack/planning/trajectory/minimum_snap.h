// Piecewise polynomials of least snap through waypoints at given times, after Richter, Bry and Roy (2016): a
// quadratic program whose unknowns are the derivatives at the waypoints, so that no constraint is left.
//
// Pieces are of degree 7. Between fixed times and places the curve of least snap has p^(8) = 0 (the
// Euler-Lagrange equation), and choosing the joints' derivatives freely makes it continuous up to the sixth:
// pieces of degree 9, as in the article, would come out the same.
#pragma once
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

/// One piece; coefficients are of time / duration in [0, 1], the constant first, one column an axis.
struct PolynomialPiece {
  using Coefficients = Eigen::Matrix<double, 8, 3>;
  double duration_s = 0;
  Coefficients coefficients = Coefficients::Zero();

  /// The position's derivative of that order, `t_s` after the piece's begin.
  Vec3 at(double t_s, int order) const;
};

struct Polynomial {
  std::vector<PolynomialPiece> pieces;
  double snap_cost = 0;  // integral of the squared snap, m^2/s^7

  double duration_s() const;
  Vec3 at(double t_s, int order) const;  // before the begin and after the end: there
};

struct Departure {
  Vec3 velocity_mps = Vec3::Zero(), acceleration_mps2 = Vec3::Zero();
};

/// Through `waypoints` (two at least, no two following ones equal in time), departing as given and ending at
/// rest: velocity and acceleration 0. Jerk at both ends is free, as the tracker only bounds it. Durations are
/// positive, one fewer than waypoints.
Polynomial minimum_snap(const std::vector<Vec3>& waypoints, const std::vector<double>& durations_s,
                        const Departure& departure);

}  // namespace karst::core
