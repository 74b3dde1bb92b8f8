#include "core_stack/control/jerk_mpc.h"

#include <gtest/gtest.h>

#include "tests/unit/control/mpc_problems.h"
#include "tests/unit/control/slsqp_oracle.h"

namespace karst::core::test {
namespace {

Eigen::VectorXd stacked(const JerkPlan& plan) {
  const auto n = static_cast<Eigen::Index>(plan.jerk_mps3.size());
  Eigen::VectorXd out(3 * n);
  for (Eigen::Index k = 0; k < n; ++k)
    for (int axis = 0; axis < 3; ++axis)
      out[axis * n + k] = plan.jerk_mps3[static_cast<std::size_t>(k)][axis];
  return out;
}

std::vector<MotionTarget> straight_targets(const JerkMpcSetup& s, const Vec3& from, const Vec3& velocity) {
  std::vector<MotionTarget> out;
  for (int k = 1; k <= s.steps; ++k) out.push_back({from + velocity * (k * s.step_s), velocity});
  return out;
}

TEST(JerkMpc, TerminalWeightSolvesTheRiccatiEquation) {
  const JerkMpcSetup s;
  const double d = s.step_s;
  const Eigen::Matrix3d P = terminal_weight(s);
  Eigen::Matrix3d A;
  A << 1, d, d * d / 2, 0, 1, d, 0, 0, 1;
  const Vec3 B(d * d * d / 6, d * d / 2, d);
  const Eigen::Matrix3d Q = Vec3(s.position_weight, s.velocity_weight, s.acceleration_weight).asDiagonal();
  const Eigen::RowVector3d K = B.transpose() * P * A / (s.jerk_weight + B.dot(P * B));
  const Eigen::Matrix3d residual = Q + A.transpose() * P * (A - B * K) - P;
  EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1e-8 * P.maxCoeff());
  EXPECT_LT((A - B * K).eigenvalues().cwiseAbs().maxCoeff(), 1.0);
}

TEST(JerkMpc, FarFromAllLimitsItIsTheLeastSquaresSolution) {
  JerkMpcSetup s;
  s.max_speed_mps = s.max_acceleration_mps2 = s.max_jerk_mps3 = 1e4;
  const Motion start{{0.1, -0.2, 0.05}, {0.3, 0.1, 0}, {0.1, 0, -0.2}};
  const auto targets = straight_targets(s, Vec3::Zero(), {0.5, 0.2, -0.1});
  const DenseProblem dense(s, start, targets);
  // The cost is quadratic: its minimum from the gradient at zero and the gradients' differences.
  const int n = 3 * s.steps;
  Eigen::VectorXd g0, g;
  dense.cost(Eigen::VectorXd::Zero(n), &g0);
  Eigen::MatrixXd H(n, n);
  for (int i = 0; i < n; ++i) {
    dense.cost(Eigen::VectorXd::Unit(n, i), &g);
    H.col(i) = g - g0;
  }
  const Eigen::VectorXd best = -H.ldlt().solve(g0);
  JerkMpc mpc(s);
  EXPECT_LT((stacked(mpc.solve(start, targets, -1)) - best).cwiseAbs().maxCoeff(), 2e-3);
}

TEST(JerkMpc, CostsWhatSlsqpFindsAndKeepsTheLimitsInAThousandRandomProblems) {
  Random r(11);
  JerkMpcSetup s;
  s.steps = 12;
  s.step_s = 0.1;
  int at_limits = 0, stuck = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    Motion start = random_start(r, s);
    auto targets = random_targets(r, s, start);
    JerkMpc mpc(s);
    mpc.solve(start, targets, -1);
    if (trial % 2 == 1) {  // 10 ms later, warm; now and then towards something else
      start = advanced(start, mpc.plan().jerk_mps3[0], 0.01);
      if (trial % 10 == 1) targets = random_targets(r, s, start);
      mpc.solve(start, targets, 0.01);
    }
    const JerkPlan& plan = mpc.plan();
    ASSERT_TRUE(plan.converged) << trial;
    const DenseProblem dense(s, start, targets);
    const SlsqpResult oracle = SlsqpProblem(dense).solve(1e-9, 500);
    ASSERT_TRUE(oracle.converged) << trial;
    const double cost = dense.cost(stacked(plan), nullptr);
    ASSERT_LE(cost, 1.001 * oracle.cost) << trial;
    // Cheaper within the limits: it is SLSQP that was stuck.
    stuck += cost < 0.999 * oracle.cost;
    const double excess = violation(s, start, plan.jerk_mps3);
    ASSERT_LE(excess, 1e-6) << trial;
    at_limits += excess > -1e-3;
  }
  EXPECT_LE(stuck, 3);
  EXPECT_GT(at_limits, 700) << "the problems must reach the limits";
}

TEST(JerkMpc, KeepsTheLimitsOverTheWholeHorizonToo) {
  Random r(12);
  const JerkMpcSetup s;
  for (int trial = 0; trial < 1000; ++trial) {
    const Motion start = random_start(r, s);
    const auto targets = random_targets(r, s, start);
    JerkMpc mpc(s);
    ASSERT_TRUE(mpc.solve(start, targets, -1).converged) << trial;
    ASSERT_LE(violation(s, start, mpc.plan().jerk_mps3), 1e-6) << trial;
    const Motion next = advanced(start, mpc.plan().jerk_mps3[0], s.step_s);
    ASSERT_TRUE(mpc.solve(next, targets, s.step_s).converged) << trial;
    ASSERT_LE(violation(s, next, mpc.plan().jerk_mps3), 1e-6) << trial;
  }
}

TEST(JerkMpc, WarmStartsReachTheSamePlanAsColdOnes) {
  const JerkMpcSetup s;
  JerkMpc warm(s);
  Motion m;
  int warm_iterations = 0, cold_iterations = 0;
  for (int i = 0; i < 150; ++i) {
    const auto targets = straight_targets(s, Vec3(0.01 * i, 0.005 * i, 0), {1.0, 0.5, 0});
    const JerkPlan& plan = warm.solve(m, targets, i == 0 ? -1 : 0.01);
    JerkMpc cold(s);
    const JerkPlan& same = cold.solve(m, targets, -1);
    ASSERT_LT((plan.jerk_mps3[0] - same.jerk_mps3[0]).norm(), 0.1) << "at " << i;
    warm_iterations += plan.iterations, cold_iterations += same.iterations;
    m = advanced(m, plan.jerk_mps3[0], 0.01);
  }
  EXPECT_LT(2 * warm_iterations, cold_iterations);
}

TEST(JerkMpc, AStartBeyondTheLimitsIsBroughtBack) {
  const JerkMpcSetup s;
  JerkMpc mpc(s);
  Motion m{Vec3::Zero(), {2.3, 0.5, 0}, {0.5, 0, 2.2}};
  const std::vector<MotionTarget> hover(static_cast<std::size_t>(s.steps));
  for (int i = 0; i < 300; ++i) {
    const JerkPlan& plan = mpc.solve(m, hover, i == 0 ? -1 : 0.01);
    ASSERT_TRUE(plan.jerk_mps3[0].allFinite());
    m = advanced(m, plan.jerk_mps3[0], 0.01);
    if (i > 80) {
      EXPECT_LT(m.velocity_mps.norm(), s.max_speed_mps * 1.01);
      EXPECT_LT(m.acceleration_mps2.norm(), s.max_acceleration_mps2 * 1.01);
    }
  }
}

TEST(JerkMpc, AtRestOnItsTargetItStaysThere) {
  JerkMpc mpc(JerkMpcSetup{});
  const std::vector<MotionTarget> here(40, {Vec3(3, -2, 1), Vec3::Zero()});
  const JerkPlan& plan = mpc.solve({Vec3(3, -2, 1), Vec3::Zero(), Vec3::Zero()}, here, -1);
  for (const Vec3& j : plan.jerk_mps3) EXPECT_LT(j.norm(), 1e-9);
}

TEST(Advanced, IsTheIntegralOfConstantJerk) {
  const Motion start{{1, 2, 3}, {0.5, -0.5, 1}, {0.2, 0.1, -0.3}};
  const Vec3 jerk(3, -4, 5);
  Motion m = start;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {  // midpoint rule in small steps
    const double dt = 0.5 / n;
    const Vec3 a = m.acceleration_mps2 + jerk * dt / 2;
    m.position += (m.velocity_mps + m.acceleration_mps2 * dt / 2) * dt;
    m.velocity_mps += a * dt;
    m.acceleration_mps2 += jerk * dt;
  }
  const Motion exact = advanced(start, jerk, 0.5);
  EXPECT_LT((exact.position - m.position).norm(), 1e-8);
  EXPECT_LT((exact.velocity_mps - m.velocity_mps).norm(), 1e-8);
  EXPECT_LT((exact.acceleration_mps2 - m.acceleration_mps2).norm(), 1e-8);
}

}  // namespace
}  // namespace karst::core::test
