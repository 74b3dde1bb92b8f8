#include "core_stack/control/jerk_mpc.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace karst::core {
namespace {

// Softness: m/s, m/s^2 or m/s^3 of violation for one unit of multiplier. Multipliers of problems that can be
// solved stay below 1e5; the soft one is for starts from which the limits cannot be kept.
constexpr double kHard = 1e-11, kSoft = 4e-6;
// Mean slack * multiplier at which a solution is good. Their sum bounds how far its cost is from the best
// one.
constexpr double kFinalMu = 1e-4, kFinalMuOfCost = 5e-6;
constexpr double kResidual = 1e-5;       // of slacks against their limits
constexpr double kViolation = 4e-7;      // of a limit, as a share of it, beyond what softness buys
constexpr double kJerkTolerance = 3e-3;  // last Newton step, as a share of the jerk limit
// With multipliers of 1e4 and slacks of 1e-5 rounding moves single jerks about; then the cost has settled
// long before.
constexpr double kConvergedJerk = 0.1,
                 kConvergedCost = 1e-5;  // of the limit and of the cost, after a whole step
constexpr int kMaxIterations = 40;
constexpr double kCreeping = 0.05;  // share of a Newton step; so short four times in a row, a start was bad
constexpr double kGoodExcess = 0.005;  // over a limit, as a share of it, that a plan given up early may have
constexpr double kToBoundary = 0.99;
// A shifted plan touches its limits; the iteration starts a little inside, with products near a small mu.
constexpr double kWarmFraction = 1e-3;                 // of the mu of a cold start
constexpr double kWarmSlack = 1e-3, kColdSlack = 0.1;  // least slack, as a share of the limit
constexpr double kWarmSpread = 1e4;  // how far above mu a kept multiplier may put its product

double ball_value(const Vec3& y, double limit) { return (limit * limit - y.squaredNorm()) / (2 * limit); }

/// Share of the way to where `value` + t `step` - t^2 `curvature` (curvature >= 0) reaches zero, at most 1.
double step_to_zero(double value, double step, double curvature = 0) {
  if (value + step - curvature > (1 - kToBoundary) * value) return 1;
  const double root = std::sqrt(step * step + 4 * curvature * value);
  return std::min(1.0, kToBoundary * 2 * value / (root - step));
}

}  // namespace

Motion advanced(const Motion& m, const Vec3& j, double dt) {
  return {m.position + m.velocity_mps * dt + m.acceleration_mps2 * (dt * dt / 2) + j * (dt * dt * dt / 6),
          m.velocity_mps + m.acceleration_mps2 * dt + j * (dt * dt / 2), m.acceleration_mps2 + j * dt};
}

Eigen::Matrix3d terminal_weight(const JerkMpcSetup& s) {
  const double d = s.step_s;
  Eigen::Matrix3d A;
  A << 1, d, d * d / 2, 0, 1, d, 0, 0, 1;
  const Vec3 B(d * d * d / 6, d * d / 2, d);
  const Eigen::Matrix3d Q = Vec3(s.position_weight, s.velocity_weight, s.acceleration_weight).asDiagonal();
  Eigen::Matrix3d P = Q;
  for (int i = 0; i < 10000; ++i) {
    const Eigen::RowVector3d BtPA = B.transpose() * P * A;
    const Eigen::Matrix3d next =
        Q + A.transpose() * P * A - BtPA.transpose() * BtPA / (s.jerk_weight + B.dot(P * B));
    const double change = (next - P).cwiseAbs().maxCoeff();
    P = (next + next.transpose()) / 2;
    if (change < 1e-12 * P.cwiseAbs().maxCoeff()) break;
  }
  return P;
}

JerkMpc::JerkMpc(const JerkMpcSetup& setup)
    : setup_(setup), terminal_(terminal_weight(setup)), stages_(static_cast<std::size_t>(setup.steps)) {
  shifted_.reserve(stages_.size());
  plan_.jerk_mps3.assign(stages_.size(), Vec3::Zero());
  plan_.motion.resize(stages_.size());
}

/// The old plan's acceleration, read at the new nodes, gives the new jerks.
void JerkMpc::shift(double elapsed_s, const Motion& start) {
  const double fraction = std::clamp(elapsed_s / setup_.step_s, 0.0, 1.0);
  const std::size_t n = stages_.size();
  Vec3 before = start.acceleration_mps2;
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3& a = plan_.motion[k].acceleration_mps2;
    const Vec3& b = plan_.motion[std::min(k + 1, n - 1)].acceleration_mps2;
    const Vec3 at_node = (1 - fraction) * a + fraction * b;
    plan_.jerk_mps3[k] = (at_node - before) / setup_.step_s;
    before = at_node;
  }
}

void JerkMpc::roll_out(const Motion& start) {
  Motion m = start;
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    m = advanced(m, plan_.jerk_mps3[k], setup_.step_s);
    plan_.motion[k] = m;
  }
}

void JerkMpc::start_multipliers(Start start, std::span<const MotionTarget> targets) {
  const bool warm = start == Start::warm;
  cost_ = 0;
  for (std::size_t i = 0; i < stages_.size(); ++i)
    cost_ += setup_.position_weight / 2 * (plan_.motion[i].position - targets[i].position).squaredNorm();
  const double cold_mu = std::max(0.1, cost_ / (3.0 * static_cast<double>(stages_.size())));
  const auto begin = [&](Ball& ball, const Vec3& y, double limit) {
    const double mu = warm ? std::max(kFinalMu, kWarmFraction * cold_mu) : cold_mu;
    const double value = ball_value(y, limit);
    const double floor = (warm ? kWarmSlack : kColdSlack) * limit;
    ball.inside = value >= floor;
    ball.slack = std::max(value, floor);
    const double central = mu / ball.slack;
    ball.multiplier = warm ? std::clamp(ball.multiplier, central / 3, kWarmSpread * central) : central;
  };
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    begin(stages_[k].speed, plan_.motion[k].velocity_mps, setup_.max_speed_mps);
    begin(stages_[k].acceleration, plan_.motion[k].acceleration_mps2, setup_.max_acceleration_mps2);
    begin(stages_[k].jerk, plan_.jerk_mps3[k], setup_.max_jerk_mps3);
  }
}

double JerkMpc::excess() const {
  double worst = 0;
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    const Motion& m = plan_.motion[k];
    worst = std::max({worst, m.velocity_mps.norm() / setup_.max_speed_mps,
                      m.acceleration_mps2.norm() / setup_.max_acceleration_mps2,
                      plan_.jerk_mps3[k].norm() / setup_.max_jerk_mps3});
  }
  return worst - 1;
}

/// One Newton step on the perturbed optimality conditions, with e = multiplier * softness the violation
/// bought:
///   c(y) + e - slack = 0,  slack * multiplier = mu,  gradient of the Lagrangian = 0.
/// Slack and multiplier are eliminated, which leaves a linear-quadratic problem in the steps of state and
/// jerk: each limit adds (multiplier / limit) I + w n n' to its block, with n = y / limit.
double JerkMpc::newton_step(std::span<const MotionTarget> targets, double mu) {
  const auto add_limit = [this, mu](Ball& ball, const Vec3& y, double limit, auto&& hessian,
                                    auto&& gradient) {
    const double value = ball_value(y, limit) + ball.multiplier * softness_;
    ball.inside = ball.inside || value >= ball.slack;
    if (ball.inside) ball.slack = value;
    ball.residual = value - ball.slack;
    ball.centering = mu - ball.slack * ball.multiplier;
    const double stiffness = 1 / (ball.slack + ball.multiplier * softness_);
    const Vec3 n = y / limit;
    hessian.diagonal().array() += ball.multiplier / limit;
    hessian += (ball.multiplier * stiffness) * n * n.transpose();
    gradient += (ball.multiplier + (ball.centering - ball.multiplier * ball.residual) * stiffness) * n;
  };
  const double d = setup_.step_s, d2 = d * d / 2, d3 = d * d * d / 6;
  cost_ = 0;
  Mat9 P = Mat9::Zero();  // value function's curvature and slope after stage k
  Vec9 p = Vec9::Zero();
  for (std::size_t i = stages_.size(); i-- > 0;) {
    Stage& s = stages_[i];
    const Motion& m = plan_.motion[i];
    const Vec3 e_p = m.position - targets[i].position;
    const Vec3 e_v = m.velocity_mps - targets[i].velocity_mps;
    const Vec3& e_a = m.acceleration_mps2;
    cost_ += setup_.jerk_weight * plan_.jerk_mps3[i].squaredNorm() / 2;
    if (i + 1 == stages_.size()) {
      for (int r = 0; r < 3; ++r) {
        p.segment<3>(3 * r) = terminal_(r, 0) * e_p + terminal_(r, 1) * e_v + terminal_(r, 2) * e_a;
        for (int c = 0; c < 3; ++c) P.block<3, 3>(3 * r, 3 * c).diagonal().setConstant(terminal_(r, c));
      }
      cost_ += (e_p.dot(p.segment<3>(0)) + e_v.dot(p.segment<3>(3)) + e_a.dot(p.segment<3>(6))) / 2;
    } else {
      cost_ += (setup_.position_weight * e_p.squaredNorm() + setup_.velocity_weight * e_v.squaredNorm() +
                setup_.acceleration_weight * e_a.squaredNorm()) /
               2;
      P.diagonal().segment<3>(0).array() += setup_.position_weight;
      P.diagonal().segment<3>(3).array() += setup_.velocity_weight;
      P.diagonal().segment<3>(6).array() += setup_.acceleration_weight;
      p.segment<3>(0) += setup_.position_weight * e_p;
      p.segment<3>(3) += setup_.velocity_weight * e_v;
      p.segment<3>(6) += setup_.acceleration_weight * e_a;
    }
    add_limit(s.speed, m.velocity_mps, setup_.max_speed_mps, P.block<3, 3>(3, 3), p.segment<3>(3));
    add_limit(s.acceleration, m.acceleration_mps2, setup_.max_acceleration_mps2, P.block<3, 3>(6, 6),
              p.segment<3>(6));

    // One step back: x+ = A x + B j, A = [1 d d2; 0 1 d; 0 0 1] and B = [d3; d2; d], each times the identity.
    const Vec3& j = plan_.jerk_mps3[i];
    const Mat39 BtP = d3 * P.topRows<3>() + d2 * P.middleRows<3>(3) + d * P.bottomRows<3>();
    Eigen::Matrix3d R = d3 * BtP.leftCols<3>() + d2 * BtP.middleCols<3>(3) + d * BtP.rightCols<3>();
    R.diagonal().array() += setup_.jerk_weight;
    Vec3 r = setup_.jerk_weight * j + d3 * p.segment<3>(0) + d2 * p.segment<3>(3) + d * p.segment<3>(6);
    add_limit(s.jerk, j, setup_.max_jerk_mps3, R, r);
    Mat39 H = BtP;  // B'PA
    H.rightCols<3>() += d * BtP.middleCols<3>(3) + d2 * BtP.leftCols<3>();
    H.middleCols<3>(3) += d * BtP.leftCols<3>();
    const Eigen::Matrix3d R_inverse = R.inverse();
    s.feedback.noalias() = R_inverse * H;
    s.feedforward.noalias() = R_inverse * r;
    P.rightCols<3>() += d * P.middleCols<3>(3) + d2 * P.leftCols<3>();  // P A
    P.middleCols<3>(3) += d * P.leftCols<3>();
    P.bottomRows<3>() += d * P.middleRows<3>(3) + d2 * P.topRows<3>();  // A' P A
    P.middleRows<3>(3) += d * P.topRows<3>();
    // By coefficients: for three terms each, Eigen's product of large matrices takes four times as long.
    P.noalias() -= H.transpose().lazyProduct(s.feedback);
    p.segment<3>(6) += d * p.segment<3>(3) + d2 * p.segment<3>(0);
    p.segment<3>(3) += d * p.segment<3>(0);
    p.noalias() -= H.transpose() * s.feedforward;
  }

  double length = 1;
  const auto step_limit = [this, &length](Ball& ball, const Vec3& y, const Vec3& y_step, double limit) {
    const double c_step = -y.dot(y_step) / limit;
    ball.multiplier_step = (ball.centering - ball.multiplier * (ball.residual + c_step)) /
                           (ball.slack + ball.multiplier * softness_);
    ball.slack_step = c_step + ball.multiplier_step * softness_ + ball.residual;
    // Where the limit holds, the slack follows its curve; elsewhere it goes straight.
    const double curvature = ball.inside ? y_step.squaredNorm() / (2 * limit) : 0;
    length = std::min({length, step_to_zero(ball.slack, ball.slack_step, curvature),
                       step_to_zero(ball.multiplier, ball.multiplier_step)});
  };
  Vec9 x = Vec9::Zero();
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    Stage& s = stages_[i];
    s.jerk_step = -s.feedforward - s.feedback * x;
    x.segment<3>(0) += d * x.segment<3>(3) + d2 * x.segment<3>(6) + d3 * s.jerk_step;
    x.segment<3>(3) += d * x.segment<3>(6) + d2 * s.jerk_step;
    x.segment<3>(6) += d * s.jerk_step;
    s.state_step = x;
    step_limit(s.speed, plan_.motion[i].velocity_mps, x.segment<3>(3), setup_.max_speed_mps);
    step_limit(s.acceleration, plan_.motion[i].acceleration_mps2, x.segment<3>(6),
               setup_.max_acceleration_mps2);
    step_limit(s.jerk, plan_.jerk_mps3[i], s.jerk_step, setup_.max_jerk_mps3);
  }
  return length;
}

/// Iterates from the present plan and multipliers; false if it gave up.
bool JerkMpc::iterate(const Motion& start, std::span<const MotionTarget> targets, Patience patience) {
  const auto for_each_ball = [this](auto&& f) {
    for (Stage& s : stages_) {
      f(s.speed);
      f(s.acceleration);
      f(s.jerk);
    }
  };
  double shrink = 0.2;
  int creeping = 0;
  bool whole_step = false;
  for (int i = 0; i < kMaxIterations && (patience == Patience::full || creeping < 4); ++i) {
    ++plan_.iterations;
    double mu = 0;
    for_each_ball([&](const Ball& b) { mu += b.slack * b.multiplier; });
    mu /= 3.0 * static_cast<double>(stages_.size());
    const double gap = i < kMaxIterations / 2 ? kFinalMuOfCost : 2 * kFinalMuOfCost;  // it may be too narrow
    const double good_mu = std::max(kFinalMu, gap * cost_), last_cost = cost_;
    const double length = newton_step(targets, std::max(shrink * mu, good_mu));

    double residual = 0, jerk_step = 0, bought = 0;
    for_each_ball([&](Ball& b) {
      residual = std::max(residual, std::abs(b.residual));
      b.slack += length * b.slack_step;
      b.multiplier += length * b.multiplier_step;
      bought = std::max(bought, b.multiplier * softness_);
    });
    for (std::size_t k = 0; k < stages_.size(); ++k) {
      const Stage& s = stages_[k];
      jerk_step = std::max(jerk_step, s.jerk_step.norm());
      plan_.jerk_mps3[k] += length * s.jerk_step;
      plan_.motion[k].position += length * s.state_step.segment<3>(0);
      plan_.motion[k].velocity_mps += length * s.state_step.segment<3>(3);
      plan_.motion[k].acceleration_mps2 += length * s.state_step.segment<3>(6);
    }
    // Short steps mean products far apart: go back towards the central path before going on.
    shrink = length > 0.9 ? 0.1 : length > 0.4 ? 0.3 : length > 0.1 ? 1.0 : 10.0;
    creeping = length < kCreeping ? creeping + 1 : 0;
    const bool converged = whole_step && std::abs(cost_ - last_cost) < kConvergedCost * cost_;
    const double tolerance = (converged ? kConvergedJerk : kJerkTolerance) * setup_.max_jerk_mps3;
    whole_step = length > 0.9;
    if (whole_step && mu < 2 * good_mu && residual < kResidual && jerk_step < tolerance &&
        excess() < kViolation + (softness_ == kSoft ? bought : 0)) {
      roll_out(start);  // sheds the rounding of the summed steps
      return true;
    }
  }
  return false;
}

const JerkPlan& JerkMpc::solve(const Motion& start, std::span<const MotionTarget> targets, double elapsed_s) {
  const auto start_cold = [&] {
    std::fill(plan_.jerk_mps3.begin(), plan_.jerk_mps3.end(), Vec3::Zero());
    roll_out(start);
    start_multipliers(Start::cold, targets);
  };
  plan_.iterations = 0;
  softness_ = kHard;
  const bool warm = elapsed_s >= 0;
  double shifted_excess = 0;
  bool solved = false;
  if (warm) {
    shift(elapsed_s, start);
    roll_out(start);
    shifted_ = plan_.jerk_mps3;
    shifted_excess = excess();
    start_multipliers(plan_.converged ? Start::warm : Start::cold, targets);
    solved = iterate(start, targets, Patience::little);
  }
  if (!solved) {
    start_cold();
    solved = iterate(start, targets, Patience::full);
  }
  if (!solved) {
    softness_ = kSoft;
    start_cold();
    solved = iterate(start, targets, Patience::full);
  }
  plan_.converged = solved;
  if (solved) return plan_;
  roll_out(start);
  if (warm && excess() > std::max(shifted_excess, kGoodExcess)) {
    plan_.jerk_mps3 = shifted_;  // going on as planned keeps the limits; the next solution may do better
    roll_out(start);
  }
  return plan_;
}

}  // namespace karst::core
