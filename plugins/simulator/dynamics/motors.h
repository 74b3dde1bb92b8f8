// Four motors in an X: mixing of thrust and torque, and their lag.
#pragma once
#include "plugins/simulator/dynamics/rigid_body.h"

namespace karst::sim {

/// Newtons of front left, front right, rear left, rear right.
using MotorThrusts = Eigen::Vector4d;

struct MotorModel {
  double thrust_to_weight = 2.2;  // of all four motors together
  double arm_m = 0.2;             // from the centre to each motor
  double yaw_moment_m = 0.016;    // reaction torque over thrust
  double time_constant_s = 0.025;
  std::int64_t weak = 0;  // number of a motor that is worn, 1 to 4 in the order of MotorThrusts; 0: none
  double weak_fraction = 0.9, weak_after_s = 0;
};
void describe(core::OptionTable& t, MotorModel& m);

double max_motor_thrust_n(const MotorModel& motors, const BodyModel& body);

/// Thrust and torque that four motors exert together.
Wrench wrench_of(const MotorModel& model, const MotorThrusts& f);

/// Motor thrusts in [0, max_n] that exert `wanted` where that is possible. Otherwise roll and pitch have
/// priority, because they keep the vehicle upright, then collective thrust, then yaw.
MotorThrusts mix(const MotorModel& model, double max_n, const Wrench& wanted);

/// Thrusts actually exerted at time `t_s` by motors that turn for thrusts `f`: a worn motor gives less.
MotorThrusts exerted(const MotorModel& model, const MotorThrusts& f, double t_s);

/// First-order lag, exact for a command that is constant over the step.
MotorThrusts follow(const MotorModel& model, const MotorThrusts& f, const MotorThrusts& commanded,
                    double dt_s);

}  // namespace karst::sim
