// Registers a sweep in the local map: Gauss-Newton on the distances of its matches.
//
// With T = (R, t) the body in the world, and p a point of the sweep in the body frame that belongs on the
// plane through q with unit normal n, the residual and its derivatives by t + dt, R exp(dw) are
//
//   r = n' (R p + t - q),    dr/ddt = n',    dr/ddw = (p x R' n)'
//
// A line is represented by the two planes that intersect in it. A match of variance s^2 has weight 1 / s^2,
// times the robust weight (1 + (r/k)^2)^-2 of Geman and McClure, whose width k shrinks as the fit improves.
//
// Degeneracy, after Zhang, Kaess and Singh (ICRA 2016): rotations are scaled to the displacement of a point
// at the matches' mean distance L, so that all six unknowns are in metres. The information matrix divided by
// the sum of the weights then holds mean squared cosines between directions of motion and normals. An
// eigenvector with an eigenvalue below a threshold is a direction the sweep does not observe: there the pose
// keeps its initial guess, and the covariance is huge. The vertical may have a higher threshold.
#pragma once
#include "core_stack/localization/matching.h"
#include "core_stack/localization/state.h"

namespace karst::core {

using Vector6 = Eigen::Matrix<double, 6, 1>;

struct RegistrationOptions {
  std::int64_t max_passes = 4;
  std::int64_t max_steps = 6;
  double degenerate_fraction = 0.002;
  /// Of the vertical, which IMU and barometer tell as well: better than a few matches do.
  double degenerate_fraction_vertical = 0.01;
  std::int64_t min_matches = 60;
  double min_matched_fraction = 0.25;
};
void describe(OptionTable& t, RegistrationOptions& o);

struct Fit {
  Pose T_world_body;
  Matrix6 covariance = Matrix6::Zero();  // translation (world), rotation (body)
  int free_directions = 0;
  bool good = false;
  int edges = 0, planes = 0;
  double matched_fraction = 0;  // of the candidate places
  double rms_residual_m = 0;    // with robust weights
};

/// Starts from `guess` with surface grid `first_level` and proceeds to the finest one.
Fit fit_to_map(const Cloud& cloud_body, const LocalMap& map, const Pose& guess, std::size_t first_level,
               const RegistrationOptions& options, Workspace& workspace);

/// Weighted sums over all matches at a pose.
struct NormalEquations {
  Matrix6 information = Matrix6::Zero();         // sum w j j'
  Vector6 gradient = Vector6::Zero();            // sum w j r
  double weight = 0;                             // sum w
  double squared_distance = 0;                   // sum w |p|^2
  double robust = 0, absolute = 0, squared = 0;  // sums of the robust weight u, u |r|, u r^2
};
NormalEquations linearize(const std::vector<Match>& matches, const Pose& T_world_body, double width_m,
                          int threads);

/// The step that solves the equations along the observed directions, and the covariance.
struct Step {
  Vector6 change = Vector6::Zero();  // dt, dw
  Matrix6 covariance = Matrix6::Zero();
  int free_directions = 0;
};
Step solve(const NormalEquations& equations, double degenerate_fraction, double vertical_fraction);

}  // namespace karst::core
