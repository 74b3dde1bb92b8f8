// Pose graph: poses that agree best, in the least squares sense, with measured poses relative to each other.
//
// With Z the measured pose of j in i, (R, t) the poses, and steps t + dt, R exp(dw), the error of an edge is
//
//   e = ( R_Z' (R_i' (t_j - t_i) - t_Z),  log(R_Z' R_i' R_j) )
//
// and its cost e' W e, W the inverse of the measurement's covariance. Levenberg and Marquardt's method
// minimizes the sum; a sparse Cholesky factorization solves each step. Edges that may be wrong (loop
// closures) get the weight (c^2 / (c^2 + e' W e))^2 of Geman and McClure, whose width c begins so wide that
// all edges count, and shrinks to its end value in steps (graduated non-convexity: Yang et al., RA-L 2020).
// The drift before a closure does not make it an outlier then.
//
// The first pose is held. Where gravity is known, a pose's z axis is measured as up.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/localization/state.h"

namespace karst::core {

struct GraphEdge {
  std::size_t from = 0, to = 0;  // indices of poses
  Pose T_from_to;
  Matrix6 information = Matrix6::Identity();  // translation in m, rotation in rad; both in the frame of `to`
  bool robust = false;                        // its weight depends on how well it agrees with the others
};

struct PoseGraphOptions {
  std::int64_t max_steps = 30;              // of Levenberg and Marquardt, for each width of the kernel
  double kernel_width = 6;                  // c, in standard deviations of the whole error
  std::optional<double> up_sigma_rad = {};  // of each pose's z axis against the world's; none: not known
};

struct PoseGraphResult {
  std::vector<Pose> poses;
  std::vector<double> weights;  // of the edges: 1, or the robust weight at the end
  double cost = 0;              // sum of the weighted squared errors
};

/// The error of an edge, and its derivatives by the steps of both poses.
struct EdgeError {
  Eigen::Matrix<double, 6, 1> error;
  Matrix6 by_from, by_to;
};
EdgeError error_of(const GraphEdge& edge, const Pose& from, const Pose& to);

/// Starts from `poses`. Every pose must be linked to the first by edges that are not robust. Deterministic.
PoseGraphResult optimize(std::vector<Pose> poses, const std::vector<GraphEdge>& edges,
                         const PoseGraphOptions& options);

}  // namespace karst::core
