// Where a sweep lies in the local map: Gauss-Newton on distances of its features to the map's surfaces.
//
// With T = (R, t) the body in the world, p a feature in the body frame, and a surface of the map near T p
// with mean q, the residuals are
//
//   plane with normal n:      r  = n' (R p + t - q)
//   line with direction u:    r1 = a' (R p + t - q),  r2 = b' (R p + t - q),   a, b, u orthonormal
//
// A change (dt in the world, dw in the body: t + dt, R exp(dw)) gives, with c = R' n,
//
//   dr/ddt = n',   dr/ddw = (p x c)'
//
// Each residual is weighted by 1 / s^2, s the deviation of the map's points across the surface together with
// the sensor's noise, and by Geman and McClure's w = 1 / (1 + (r/k)^2)^2, whose width k narrows as the fit
// gets better.
//
// Degeneracy, after Zhang, Kaess and Singh (ICRA 2016): rotations are measured as the way they move a feature
// at the mean distance L, so that all six numbers are metres; the information matrix over the sum of weights
// is then the mean squared cosine between a direction and the surfaces' normals. Directions (eigenvectors)
// with less than a threshold are not moved along: there the guess is kept, and the covariance says so.
#pragma once
#include "core_stack/localization/local_map.h"

namespace karst::core {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

struct RegistrationOptions {
  std::int64_t max_iterations = 10;
  double range_noise_m = 0.02;
  double max_distance_m = 0.5;  // width of the weight at first, when the guess is good
  double degenerate_share = 0.01;
  double min_matched_share = 0.3;
  std::int64_t min_matches = 100;
};
void describe(OptionTable& t, RegistrationOptions& o);

/// In the body frame.
struct Cloud {
  std::vector<Vec3f> edges, planes;
};

struct MapLevels {
  const VoxelLevel* edges;
  const VoxelLevel* fine;
  const VoxelLevel* coarse;
};

struct Fit {
  Pose T_world_body;
  Matrix6 covariance = Matrix6::Zero();
  int free_directions = 0;
  bool converged = false;
  int iterations = 0;
  int edges = 0, planes = 0;  // matched
  double matched_share = 0;   // of the features
  double rms_residual_m = 0;  // weighted
};

Fit fit_to_map(const Cloud& cloud, const MapLevels& map, const Pose& guess,
               const RegistrationOptions& options, double first_width_m, int threads);

/// r and dr/d(dt, dw) of a feature p (body) against the plane through q with normal n (world).
struct Row {
  double residual;
  Vector6 jacobian;
};
Row distance_row(const Pose& T_world_body, const Vec3& p, const Vec3& q, const Vec3& n);

}  // namespace karst::core
