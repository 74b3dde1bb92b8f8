// The optimal control problem inside the tracker, and its solver.
//
// A triple integrator in 3D follows reference positions and velocities over N steps; jerk is constant over a
// step. Speed, acceleration and jerk are bounded in the Euclidean norm. Boxes on each axis that respect the
// norms would leave only 58 % of the speed along an axis, so the three axes are solved together:
//
//   min  1/2 sum_{k=1..N} w_p |p_k - r_k|^2 + w_v |v_k - u_k|^2 + w_a |a_k|^2 + w_j |j_{k-1}|^2  + terminal
//   s.t. |v_k| <= V,  |a_k| <= A,  |j_k| <= J
//
// The terminal weight replaces the last step's: the cost-to-go of the same problem without limits.
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

struct Motion {
  Vec3 position = Vec3::Zero();
  Vec3 velocity_mps = Vec3::Zero();
  Vec3 acceleration_mps2 = Vec3::Zero();
};

/// `m` after `dt_s` of constant jerk.
Motion advanced(const Motion& m, const Vec3& jerk_mps3, double dt_s);

struct JerkMpcSetup {
  int steps = 40;
  double step_s = 0.05;
  double position_weight = 100, velocity_weight = 30, acceleration_weight = 0.3, jerk_weight = 0.1;
  double max_speed_mps = 2, max_acceleration_mps2 = 2, max_jerk_mps3 = 12;
};

/// Symmetric 3x3 on (position, velocity, acceleration) error of one axis.
Eigen::Matrix3d terminal_weight(const JerkMpcSetup& setup);

struct MotionTarget {
  Vec3 position = Vec3::Zero();
  Vec3 velocity_mps = Vec3::Zero();
};

struct JerkPlan {
  std::vector<Vec3> jerk_mps3;  // N: over [k, k+1) steps from the start
  std::vector<Motion> motion;   // N: after each step
  int iterations = 0;           // of the solver
  bool converged = false;
};

/// Primal-dual interior point; the Newton step is a Riccati recursion over the horizon, so its cost is linear
/// in N. Limits are softened by a steep quadratic penalty: a start beyond them is brought back, never an
/// error.
class JerkMpc {
 public:
  explicit JerkMpc(const JerkMpcSetup& setup);
  /// `targets`: N, for the ends of the steps. `elapsed_s` since the previous start shifts the previous plan
  /// to start the iteration from; a negative value starts cold.
  const JerkPlan& solve(const Motion& start, std::span<const MotionTarget> targets, double elapsed_s);
  const JerkPlan& plan() const { return plan_; }

 private:
  using Mat9 = Eigen::Matrix<double, 9, 9>;
  using Mat39 = Eigen::Matrix<double, 3, 9>;
  using Vec9 = Eigen::Matrix<double, 9, 1>;
  /// |y| <= limit as c(y) = (limit^2 - |y|^2) / (2 limit) >= 0, with slack and multiplier.
  struct Ball {
    double slack = 1, multiplier = 0;
    bool inside = false;                 // the limit holds at the current iterate, and will from now on
    double residual = 0, centering = 0;  // right-hand sides of the current Newton step
    double slack_step = 0, multiplier_step = 0;
  };
  struct Stage {
    Ball speed, acceleration, jerk;
    Mat39 feedback;
    Vec3 feedforward, jerk_step;
    Vec9 state_step;  // at the stage's end
  };
  void shift(double elapsed_s, const Motion& start);
  void roll_out(const Motion& start);
  double excess() const;            // of the plan over its limits, as a share of them; negative within
  enum class Start { cold, warm };  // warm: from the last solution
  /// What the plan to start from costs scales the first mu.
  void start_multipliers(Start start, std::span<const MotionTarget> targets);
  /// Fills in all steps; returns the share of them that keeps slacks and multipliers positive.
  /// Also notes what the present plan costs.
  double newton_step(std::span<const MotionTarget> targets, double mu);
  enum class Patience { little, full };  // with little it gives up soon where the start was bad
  /// From the present plan and multipliers to the optimum; false if it gave up.
  bool iterate(const Motion& start, std::span<const MotionTarget> targets, Patience patience);

  JerkMpcSetup setup_;
  Eigen::Matrix3d terminal_;
  std::vector<Stage> stages_;
  std::vector<Vec3> shifted_;  // the last plan, as the present one began
  double cost_ = 0;            // of the plan at the last Newton step
  double softness_ = 0;        // of all limits
  JerkPlan plan_;
};

}  // namespace karst::core
