#include "plugins/simulator/dynamics/quadrotor.h"

namespace karst::sim {

using core::Quat;
using core::Vec3;

namespace {

constexpr double kStep_s = 0.001;
// A little more than its weight: thrust ripple while landing must not lift the vehicle again.
constexpr double kLiftOff = 1.03;

}  // namespace

Quadrotor::Quadrotor(const QuadrotorModel& model, const core::Pose& T_world_start,
                     const cave::RayScene& scene, const Wind& wind)
    : model_(model),
      max_motor_thrust_n_(max_motor_thrust_n(model.motors, model.body)),
      battery_(model.battery),
      wind_(wind),
      contact_(scene, model.body.radius_m) {
  state_.T_world_body = T_world_start;
}

QuadrotorEvent Quadrotor::advance(int steps) {
  QuadrotorEvent event = QuadrotorEvent::none;
  for (steps_done_ = 0; steps_done_ < steps && event == QuadrotorEvent::none; ++steps_done_) event = step();

  const double dt_s = steps_done_ * kStep_s;
  const bool airborne = footing_ != Footing::standing;
  const double airspeed_mps = airborne ? (state_.velocity_mps - wind_.velocity_mps()).norm() : 0;
  battery_.drain(power_w(model_.battery, model_.body, motors_, airspeed_mps), dt_s, airborne);
  wind_.advance(dt_s);
  return event;
}

QuadrotorEvent Quadrotor::step() {
  const Vec3 gyroscope = state_.body_rate_radps + gyroscope_bias_radps;
  const Wrench wanted = rate_control(model_.autopilot, model_.body, command, gyroscope);
  const MotorThrusts commanded =
      command.armed ? mix(model_.motors, max_motor_thrust_n_, wanted) : MotorThrusts(MotorThrusts::Zero());
  motors_ = follow(model_.motors, motors_, commanded, kStep_s);
  const double t_s = static_cast<double>(all_steps_++) * kStep_s;
  const Wrench wrench = wrench_of(model_.motors, exerted(model_.motors, motors_, t_s));
  const double lift_n = wrench.thrust_n * (state_.T_world_body.orientation * Vec3::UnitZ()).z();

  QuadrotorEvent event = QuadrotorEvent::none;
  if (footing_ == Footing::standing) {
    if (lift_n <= kLiftOff * model_.body.total_weight_n()) {
      level_out();
      return event;
    }
    footing_ = Footing::leaving;
    event = QuadrotorEvent::take_off;
  }
  state_ = sim::advance(model_.body, state_, wrench, wind_.velocity_mps(), kStep_s);
  const QuadrotorEvent met = meet_rock(lift_n);
  return met == QuadrotorEvent::none ? event : met;
}

QuadrotorEvent Quadrotor::meet_rock(double lift_n) {
  const std::optional<Touch> touch = contact_.touch(state_.T_world_body.position);
  if (!touch) {
    constexpr double kFree_m = 0.03;
    if (footing_ == Footing::leaving && clearance_m() > kFree_m) footing_ = Footing::airborne;
    return QuadrotorEvent::none;
  }
  last_touch_ = touch;
  const double approach_mps = state_.velocity_mps.dot(touch->direction);
  if (!supports(*touch, state_.velocity_mps)) {
    if (approach_mps <= 0) return QuadrotorEvent::none;  // already parting
    return QuadrotorEvent::crashed;
  }
  if (footing_ == Footing::leaving && lift_n > model_.body.total_weight_n()) {
    // Still carried: it may slide along the ground but not into it.
    if (approach_mps > 0) state_.velocity_mps -= approach_mps * touch->direction;
    state_.T_world_body.position -= touch->depth_m * touch->direction;
    return QuadrotorEvent::none;
  }
  if (approach_mps <= 0) return QuadrotorEvent::none;
  footing_ = Footing::standing;
  state_.velocity_mps = Vec3::Zero();
  return QuadrotorEvent::landed;
}

/// A vehicle that stands becomes level within about 0.1 s.
void Quadrotor::level_out() {
  constexpr double kSettling_s = 0.1;
  Quat& q = state_.T_world_body.orientation;
  const Quat level = core::from_heading(core::heading_of(q));
  const Quat next = q.slerp(kStep_s / kSettling_s, level).normalized();
  state_.body_rate_radps = 2 / kStep_s * (q.conjugate() * next).vec();
  state_.velocity_mps = Vec3::Zero();
  q = next;
}

}  // namespace karst::sim
