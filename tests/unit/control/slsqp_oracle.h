// The tracker's optimal control problem handed to NLopt's SLSQP, with hard limits: the oracle of the tests
// and the reference of the benchmark, given the analytic gradients of the condensed problem. Written from the
// problem's statement alone, on dense prediction matrices.
#pragma once
#include <nlopt.h>

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "core_stack/control/jerk_mpc.h"

namespace karst::core::test {

/// The problem condensed to the jerks: per axis, position, velocity and acceleration at the ends of the steps
/// are offset + matrix * jerks, and the cost is u' H u / 2 + g' u + a constant, with the same H for each
/// axis.
struct DenseProblem {
  JerkMpcSetup setup;
  Eigen::MatrixXd P, V, A, H;      // N x N
  Eigen::MatrixX3d p0, v0, a0, g;  // N x 3; the offsets are the motion without jerk
  double constant = 0;

  DenseProblem(const JerkMpcSetup& s, const Motion& start, std::span<const MotionTarget> targets) : setup(s) {
    const int n = s.steps;
    P.setZero(n, n), V.setZero(n, n), A.setZero(n, n);
    p0.resize(n, 3), v0.resize(n, 3), a0.resize(n, 3);
    Eigen::MatrixX3d e_p(n, 3), e_v(n, 3);  // off the targets, without jerk
    const double d = s.step_s;
    for (int k = 0; k < n; ++k) {
      const double time = (k + 1) * d;
      p0.row(k) = start.position + time * start.velocity_mps + time * time / 2 * start.acceleration_mps2;
      v0.row(k) = start.velocity_mps + time * start.acceleration_mps2;
      a0.row(k) = start.acceleration_mps2;
      e_p.row(k) = p0.row(k) - targets[static_cast<std::size_t>(k)].position.transpose();
      e_v.row(k) = v0.row(k) - targets[static_cast<std::size_t>(k)].velocity_mps.transpose();
      for (int i = 0; i <= k; ++i) {  // a pulse from i d to (i + 1) d, seen `after` its end
        const double after = (k - i) * d;
        A(k, i) = d;
        V(k, i) = d * d / 2 + after * d;
        P(k, i) = d * d * d / 6 + after * d * d / 2 + after * after / 2 * d;
      }
    }
    H = s.jerk_weight * Eigen::MatrixXd::Identity(n, n);
    g.setZero(n, 3);
    const Eigen::Matrix3d each =
        Vec3(s.position_weight, s.velocity_weight, s.acceleration_weight).asDiagonal();
    const Eigen::Matrix3d last = terminal_weight(s);
    for (int k = 0; k < n; ++k) {
      Eigen::MatrixXd M(3, n);
      M << P.row(k), V.row(k), A.row(k);
      Eigen::Matrix3d e;  // position, velocity, acceleration by axes
      e << e_p.row(k), e_v.row(k), a0.row(k);
      const Eigen::Matrix3d& W = k + 1 == n ? last : each;
      H += M.transpose() * W * M;
      g += M.transpose() * W * e;
      constant += 0.5 * (e.transpose() * W * e).trace();
    }
  }

  /// Cost and, where asked for, its gradient. `j` holds x of all steps, then y, then z.
  double cost(const Eigen::VectorXd& j, Eigen::VectorXd* gradient) const {
    const Eigen::Map<const Eigen::MatrixX3d> u(j.data(), setup.steps, 3);
    const Eigen::MatrixX3d Hu = H * u;
    if (gradient != nullptr) *gradient = (Hu + g).reshaped();
    return constant + (0.5 * Hu + g).cwiseProduct(u).sum();
  }
};

struct SlsqpResult {
  Eigen::VectorXd jerk;  // x of all steps, then y, then z
  double cost = 0;
  bool converged = false;  // to the tolerance, or as far as SLSQP's arithmetic goes
};

/// SLSQP in z with u = U z, U'HU the identity, and the cost divided so that it begins at 1: SLSQP's first
/// guess of the Hessian is the identity. In the jerks themselves it stops far from the optimum: their
/// Hessian's condition is 1e5 and more. NLopt's own tests of convergence compare feasible iterates alone;
/// here nearly all lie a little outside, for a ball's linearization does, and it would stop at the first pair
/// between which none was found. So the end is told here: an accepted step that keeps the limits and changes
/// the cost by less than the tolerance.
class SlsqpProblem {
 public:
  explicit SlsqpProblem(const DenseProblem& p) : p_(p) {
    const Eigen::LLT<Eigen::MatrixXd> llt(p.H);
    scale_ = std::max(p.constant, 1.0);
    U_ = std::sqrt(scale_) *
         llt.matrixU().solve(Eigen::MatrixXd::Identity(p.setup.steps, p.setup.steps)).eval();
    Vz_ = p.V * U_, Az_ = p.A * U_, gz_ = U_.transpose() * p.g / scale_;
  }

  SlsqpResult solve(double relative_tolerance, int max_evaluations) {
    const int n = p_.setup.steps;
    tolerance_ = relative_tolerance;
    SlsqpResult out;
    out.cost = std::numeric_limits<double>::infinity();
    best_ = &out;
    Eigen::MatrixX3d z = Eigen::MatrixX3d::Zero(n, 3);
    // Now and then a line search fails on its way; begun anew from elsewhere it goes on.
    for (int attempt = 0; attempt < 10 && !out.converged; ++attempt) {
      opt_ = nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(3 * n));
      nlopt_set_min_objective(opt_, &objective, this);
      const std::vector<double> tolerance(static_cast<std::size_t>(3 * n), kFeasible);
      nlopt_add_inequality_mconstraint(opt_, static_cast<unsigned>(3 * n), &constraints, this,
                                       tolerance.data());
      nlopt_set_maxeval(opt_, max_evaluations);
      last_cost_ = std::numeric_limits<double>::infinity();
      const double before = out.cost;
      if (attempt == 1) z = -gz_;  // the optimum without limits
      double ignored = 0;
      const int status = nlopt_optimize(opt_, z.data(), &ignored);
      out.converged = status == NLOPT_FORCED_STOP ||
                      (attempt > 1 && before - out.cost <= tolerance_ * std::abs(out.cost));
      nlopt_destroy(opt_);
    }
    return out;
  }

 private:
  static constexpr double kFeasible = 1e-8;

  static double objective(unsigned, const double* x, double* gradient, void* data) {
    auto& s = *static_cast<SlsqpProblem*>(data);
    const int n = s.p_.setup.steps;
    const Eigen::Map<const Eigen::MatrixX3d> z(x, n, 3);
    if (gradient != nullptr) Eigen::Map<Eigen::MatrixX3d>(gradient, n, 3) = z + s.gz_;
    return s.cost_ = s.p_.constant / s.scale_ + (0.5 * z + s.gz_).cwiseProduct(z).sum();
  }

  /// (|y|^2 - limit^2) / (2 limit) of all steps' v, then a, then j; `jacobian` row-major, constraints by
  /// variables.
  static void constraints(unsigned, double* values, unsigned, const double* x, double* jacobian, void* data) {
    auto& s = *static_cast<SlsqpProblem*>(data);
    const int n = s.p_.setup.steps;
    const Eigen::Map<const Eigen::MatrixX3d> z(x, n, 3);
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto one = [&](int row, const Eigen::MatrixXd& M, const Eigen::MatrixX3d& offset, double limit) {
      const Eigen::MatrixX3d y = M * z + offset;
      Eigen::Map<Eigen::VectorXd>(values + row, n) =
          (y.rowwise().squaredNorm().array() - limit * limit) / (2 * limit);
      if (jacobian == nullptr) return;
      Eigen::Map<RowMajor> J(jacobian, 3 * n, 3 * n);
      for (int axis = 0; axis < 3; ++axis)
        J.block(row, axis * n, n, n) = (y.col(axis) / limit).asDiagonal() * M;
    };
    const JerkMpcSetup& setup = s.p_.setup;
    one(0, s.Vz_, s.p_.v0, setup.max_speed_mps);
    one(n, s.Az_, s.p_.a0, setup.max_acceleration_mps2);
    one(2 * n, s.U_, Eigen::MatrixX3d::Zero(n, 3), setup.max_jerk_mps3);
    s.note(z, *std::max_element(values, values + 3 * n) <= kFeasible, jacobian != nullptr);
  }

  /// NLopt asks for the cost first and for the limits next, with a Jacobian once a step is accepted.
  void note(const Eigen::MatrixX3d& z, bool feasible, bool accepted) {
    if (feasible && cost_ * scale_ < best_->cost) {
      best_->cost = cost_ * scale_;
      best_->jerk = (U_ * z).reshaped();
    }
    if (!accepted) return;
    if (feasible && std::abs(cost_ - last_cost_) <= tolerance_ * std::abs(cost_)) nlopt_force_stop(opt_);
    last_cost_ = cost_;
  }

  const DenseProblem& p_;
  Eigen::MatrixXd U_, Vz_, Az_;  // u = U z
  Eigen::MatrixX3d gz_;
  nlopt_opt opt_ = nullptr;
  SlsqpResult* best_ = nullptr;
  double scale_ = 1, tolerance_ = 0, cost_ = 0, last_cost_ = 0;
};

inline SlsqpResult solve_with_slsqp(const DenseProblem& problem, double relative_tolerance,
                                    int max_evaluations) {
  return SlsqpProblem(problem).solve(relative_tolerance, max_evaluations);
}

}  // namespace karst::core::test
