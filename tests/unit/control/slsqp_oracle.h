// The tracker's optimal control problem handed to NLopt's SLSQP, with hard limits: the oracle of the tests
// and the reference of the benchmark. Written from the problem's statement alone, on dense prediction
// matrices.
#pragma once
#include <nlopt.h>

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "core_stack/control/jerk_mpc.h"

namespace karst::core::test {

/// Per axis: position, velocity, acceleration at the ends of the steps are offset + matrix * jerks.
struct DenseProblem {
  JerkMpcSetup setup;
  Eigen::Matrix3d terminal;
  std::vector<MotionTarget> targets;
  Eigen::MatrixXd P, V, A;      // N x N
  Eigen::MatrixX3d p0, v0, a0;  // N x 3, without jerk

  DenseProblem(const JerkMpcSetup& s, const Motion& start, std::span<const MotionTarget> t)
      : setup(s), terminal(terminal_weight(s)), targets(t.begin(), t.end()) {
    const int n = s.steps;
    P.setZero(n, n), V.setZero(n, n), A.setZero(n, n);
    p0.resize(n, 3), v0.resize(n, 3), a0.resize(n, 3);
    const double d = s.step_s;
    for (int k = 0; k < n; ++k) {
      const double time = (k + 1) * d;
      p0.row(k) = start.position + time * start.velocity_mps + time * time / 2 * start.acceleration_mps2;
      v0.row(k) = start.velocity_mps + time * start.acceleration_mps2;
      a0.row(k) = start.acceleration_mps2;
      for (int i = 0; i <= k; ++i) {  // a pulse from i d to (i + 1) d, seen `after` its end
        const double after = (k - i) * d;
        A(k, i) = d;
        V(k, i) = d * d / 2 + after * d;
        P(k, i) = d * d * d / 6 + after * d * d / 2 + after * after / 2 * d;
      }
    }
  }

  /// Cost and, where asked for, its gradient. `j` holds x of all steps, then y, then z.
  double cost(const Eigen::VectorXd& j, Eigen::VectorXd* gradient) const {
    const int n = setup.steps;
    double sum = 0;
    if (gradient != nullptr) gradient->setZero(3 * n);
    for (int axis = 0; axis < 3; ++axis) {
      const auto u = j.segment(axis * n, n);
      Eigen::MatrixX3d e(n, 3);
      e.col(0) = P * u + p0.col(axis);
      e.col(1) = V * u + v0.col(axis);
      e.col(2) = A * u + a0.col(axis);
      for (int k = 0; k < n; ++k) {
        e(k, 0) -= targets[static_cast<std::size_t>(k)].position[axis];
        e(k, 1) -= targets[static_cast<std::size_t>(k)].velocity_mps[axis];
      }
      Eigen::MatrixX3d weighted = e;
      weighted.col(0) *= setup.position_weight;
      weighted.col(1) *= setup.velocity_weight;
      weighted.col(2) *= setup.acceleration_weight;
      weighted.row(n - 1) = e.row(n - 1) * terminal;
      sum += 0.5 * (e.cwiseProduct(weighted).sum() + setup.jerk_weight * u.squaredNorm());
      if (gradient != nullptr)
        gradient->segment(axis * n, n) = P.transpose() * weighted.col(0) + V.transpose() * weighted.col(1) +
                                         A.transpose() * weighted.col(2) + setup.jerk_weight * u;
    }
    return sum;
  }

  /// |v|^2 - limit^2 of all steps, then the same of a and j; `jacobian` is row-major, constraints by
  /// variables.
  void limits(const Eigen::VectorXd& j, double* values, double* jacobian) const {
    const int n = setup.steps;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<Eigen::VectorXd> c(values, 3 * n);
    const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
    const Eigen::MatrixX3d zero = Eigen::MatrixX3d::Zero(n, 3);
    const auto one = [&](int row, const Eigen::MatrixXd& M, const Eigen::MatrixX3d& offset, double limit) {
      c.segment(row, n).setConstant(-limit * limit);
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::VectorXd y = M * j.segment(axis * n, n) + offset.col(axis);
        c.segment(row, n) += y.cwiseAbs2();
        if (jacobian != nullptr)
          Eigen::Map<RowMajor>(jacobian, 3 * n, 3 * n).block(row, axis * n, n, n) = 2 * y.asDiagonal() * M;
      }
    };
    one(0, V, v0, setup.max_speed_mps);
    one(n, A, a0, setup.max_acceleration_mps2);
    one(2 * n, I, zero, setup.max_jerk_mps3);
  }
};

struct SlsqpResult {
  Eigen::VectorXd jerk;  // x of all steps, then y, then z
  double cost = 0;
  int status = 0;
};

inline SlsqpResult solve_with_slsqp(const DenseProblem& problem, double relative_tolerance,
                                    int max_evaluations) {
  const auto n = static_cast<unsigned>(3 * problem.setup.steps);
  static const auto to_vector = [](unsigned size, const double* x) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(x, size));
  };
  nlopt_opt opt = nlopt_create(NLOPT_LD_SLSQP, n);
  nlopt_set_min_objective(
      opt,
      [](unsigned size, const double* x, double* g, void* data) {
        Eigen::VectorXd gradient;
        const double f = static_cast<const DenseProblem*>(data)->cost(to_vector(size, x),
                                                                      g == nullptr ? nullptr : &gradient);
        if (g != nullptr) Eigen::Map<Eigen::VectorXd>(g, size) = gradient;
        return f;
      },
      const_cast<DenseProblem*>(&problem));
  const std::vector<double> tolerance(n, 1e-8);
  nlopt_add_inequality_mconstraint(
      opt, n,
      [](unsigned, double* values, unsigned size, const double* x, double* jacobian, void* data) {
        if (jacobian != nullptr) std::fill(jacobian, jacobian + std::size_t{size} * size, 0.0);
        static_cast<const DenseProblem*>(data)->limits(to_vector(size, x), values, jacobian);
      },
      const_cast<DenseProblem*>(&problem), tolerance.data());
  nlopt_set_ftol_rel(opt, relative_tolerance);
  nlopt_set_maxeval(opt, max_evaluations);
  SlsqpResult out;
  out.jerk = Eigen::VectorXd::Zero(n);
  out.status = nlopt_optimize(opt, out.jerk.data(), &out.cost);
  nlopt_destroy(opt);
  return out;
}

}  // namespace karst::core::test
