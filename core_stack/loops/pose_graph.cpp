#include "core_stack/loops/pose_graph.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "core_stack/common/so3.h"

namespace karst::core {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Sparse = Eigen::SparseMatrix<double>;

constexpr double kSmallGain = 1e-11;  // relative: below it a step has converged
constexpr double kShrink = 0.25;      // of the squared kernel width, from one stage to the next

/// Inverse of the right Jacobian of SO(3): log(exp(v) exp(d)) = v + J d for small d.
Eigen::Matrix3d right_jacobian_inverse(const Vec3& v) {
  const double angle = v.norm();
  const Eigen::Matrix3d V = skew(v);
  const double c =
      angle < 1e-4 ? 1.0 / 12 : 1 / (angle * angle) - (1 + std::cos(angle)) / (2 * angle * std::sin(angle));
  return Eigen::Matrix3d::Identity() + 0.5 * V + c * V * V;
}

/// Poses with edges, and the width of the kernel at this stage.
struct Problem {
  const std::vector<GraphEdge>& edges;
  std::optional<double> up_sigma_rad;
  double width2;

  double weight(const GraphEdge& edge, double squared) const {
    const double shrink = width2 / (width2 + squared);
    return edge.robust ? shrink * shrink : 1;
  }
  /// The kernel itself, whose derivative by e' W e is the weight.
  double cost(const GraphEdge& edge, double squared) const {
    return edge.robust ? squared * width2 / (width2 + squared) : squared;
  }
  double cost_of(const std::vector<Pose>& poses) const {
    double sum = 0;
    for (const GraphEdge& edge : edges) {
      const Vector6 e = error_of(edge, poses[edge.from], poses[edge.to]).error;
      sum += cost(edge, e.dot(edge.information * e));
    }
    if (up_sigma_rad)
      for (std::size_t i = 1; i < poses.size(); ++i)
        sum +=
            (poses[i].orientation * Vec3::UnitZ()).head<2>().squaredNorm() / (*up_sigma_rad * *up_sigma_rad);
    return sum;
  }
};

struct Linearized {
  std::vector<Eigen::Triplet<double>> information;  // lower triangle
  Eigen::VectorXd gradient;

  explicit Linearized(std::size_t poses)
      : gradient(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * (poses - 1)))) {}

  /// Adds a block of two poses; the first pose has no unknowns.
  void add(std::size_t row, std::size_t column, const Matrix6& block) {
    if (row == 0 || column == 0) return;
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) {
        const auto at_r = static_cast<int>(6 * (row - 1)) + r, at_c = static_cast<int>(6 * (column - 1)) + c;
        if (at_r >= at_c) information.emplace_back(at_r, at_c, block(r, c));
      }
  }
  void add(std::size_t row, const Vector6& slope) {
    if (row > 0) gradient.segment<6>(static_cast<Eigen::Index>(6 * (row - 1))) += slope;
  }
};

Linearized linearized(const Problem& problem, const std::vector<Pose>& poses) {
  Linearized sums(poses.size());
  for (const GraphEdge& edge : problem.edges) {
    const EdgeError e = error_of(edge, poses[edge.from], poses[edge.to]);
    const Matrix6 W = problem.weight(edge, e.error.dot(edge.information * e.error)) * edge.information;
    sums.add(edge.from, edge.from, e.by_from.transpose() * W * e.by_from);
    sums.add(edge.to, edge.to, e.by_to.transpose() * W * e.by_to);
    sums.add(edge.to, edge.from, e.by_to.transpose() * W * e.by_from);
    sums.add(edge.from, edge.to, e.by_from.transpose() * W * e.by_to);
    sums.add(edge.from, e.by_from.transpose() * W * e.error);
    sums.add(edge.to, e.by_to.transpose() * W * e.error);
  }
  if (problem.up_sigma_rad)
    for (std::size_t i = 1; i < poses.size(); ++i) {
      // R exp(dw) z = R z - R [z]x dw
      const Eigen::Matrix3d R = poses[i].orientation.toRotationMatrix();
      const Eigen::Matrix<double, 2, 3> by_w = (-R * skew(Vec3::UnitZ())).topRows<2>();
      const double w = 1 / (*problem.up_sigma_rad * *problem.up_sigma_rad);
      Matrix6 block = Matrix6::Zero();
      block.bottomRightCorner<3, 3>() = w * by_w.transpose() * by_w;
      Vector6 slope = Vector6::Zero();
      slope.tail<3>() = w * by_w.transpose() * R.col(2).head<2>();
      sums.add(i, i, block);
      sums.add(i, slope);
    }
  return sums;
}

std::vector<Pose> moved(std::vector<Pose> poses, const Eigen::VectorXd& step) {
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Vector6 d = step.segment<6>(static_cast<Eigen::Index>(6 * (i - 1)));
    poses[i].position += d.head<3>();
    poses[i].orientation = (poses[i].orientation * exp_so3(d.tail<3>())).normalized();
  }
  return poses;
}

/// Levenberg and Marquardt at one width of the kernel.
std::vector<Pose> minimized(const Problem& problem, std::vector<Pose> poses, std::int64_t max_steps) {
  double cost = problem.cost_of(poses), damping = 1e-6;
  Eigen::SimplicialLDLT<Sparse, Eigen::Lower> solver;
  bool analyzed = false;
  for (std::int64_t i = 0; i < max_steps; ++i) {
    const Linearized sums = linearized(problem, poses);
    Sparse H(sums.gradient.size(), sums.gradient.size());
    H.setFromTriplets(sums.information.begin(), sums.information.end());
    if (!std::exchange(analyzed, true)) solver.analyzePattern(H);
    const Eigen::VectorXd diagonal = H.diagonal();
    bool better = false, converged = false;
    for (int tries = 0; tries < 8 && !better; ++tries, damping = std::max(10 * damping, 1e-9)) {
      Sparse damped = H;
      for (Eigen::Index k = 0; k < diagonal.size(); ++k)
        damped.coeffRef(k, k) += damping * diagonal[k] + 1e-12;
      solver.factorize(damped);
      if (solver.info() != Eigen::Success) continue;
      std::vector<Pose> next = moved(poses, -solver.solve(sums.gradient));
      const double next_cost = problem.cost_of(next);
      if (!(next_cost <= cost)) continue;
      converged = cost - next_cost <= kSmallGain * cost;
      better = true;
      poses = std::move(next);
      cost = next_cost;
      damping *= 0.01;  // the loop multiplies by 10 once more
    }
    if (!better || converged) break;
  }
  return poses;
}

double largest_robust_error(const std::vector<Pose>& poses, const std::vector<GraphEdge>& edges) {
  double largest = 0;
  for (const GraphEdge& edge : edges) {
    if (!edge.robust) continue;
    const Vector6 e = error_of(edge, poses[edge.from], poses[edge.to]).error;
    largest = std::max(largest, e.dot(edge.information * e));
  }
  return largest;
}

}  // namespace

EdgeError error_of(const GraphEdge& edge, const Pose& from, const Pose& to) {
  const Eigen::Matrix3d R_from = from.orientation.toRotationMatrix(),
                        R_to = to.orientation.toRotationMatrix(),
                        R_Z = edge.T_from_to.orientation.toRotationMatrix();
  const Vec3 between = R_from.transpose() * (to.position - from.position);
  const Vec3 turned = log_so3(
      (edge.T_from_to.orientation.conjugate() * from.orientation.conjugate() * to.orientation).normalized());
  const Eigen::Matrix3d J = right_jacobian_inverse(turned);
  EdgeError e;
  e.error << R_Z.transpose() * (between - edge.T_from_to.position), turned;
  e.by_from.setZero();
  e.by_to.setZero();
  e.by_from.topLeftCorner<3, 3>() = -R_Z.transpose() * R_from.transpose();
  e.by_from.topRightCorner<3, 3>() = R_Z.transpose() * skew(between);
  e.by_from.bottomRightCorner<3, 3>() = -J * R_to.transpose() * R_from;
  e.by_to.topLeftCorner<3, 3>() = R_Z.transpose() * R_from.transpose();
  e.by_to.bottomRightCorner<3, 3>() = J;
  return e;
}

PoseGraphResult optimize(std::vector<Pose> poses, const std::vector<GraphEdge>& edges,
                         const PoseGraphOptions& options) {
  PoseGraphResult result;
  const double end2 = options.kernel_width * options.kernel_width;
  Problem problem{edges, options.up_sigma_rad, std::max(end2, 4 * largest_robust_error(poses, edges))};
  if (poses.size() > 1) {
    poses = minimized(problem, std::move(poses), options.max_steps);
    while (problem.width2 > end2) {
      problem.width2 = std::max(end2, kShrink * problem.width2);
      poses = minimized(problem, std::move(poses), options.max_steps);
    }
  }
  for (const GraphEdge& edge : edges) {
    const Vector6 e = error_of(edge, poses[edge.from], poses[edge.to]).error;
    result.weights.push_back(problem.weight(edge, e.dot(edge.information * e)));
  }
  result.cost = problem.cost_of(poses);
  result.poses = std::move(poses);
  return result;
}

}  // namespace karst::core
