#include "core_stack/control/se3_controller.h"

#include <algorithm>

namespace karst::core {
namespace {

constexpr double kGravity = 9.81;  // m/s^2

/// Attitude whose z axis lies along `force` and whose x axis, seen from above, points to `heading_rad`.
Eigen::Matrix3d attitude_of(const Vec3& force, double heading_rad) {
  const Vec3 left(-std::sin(heading_rad), std::cos(heading_rad), 0);
  const Vec3 z = force.normalized();
  const Vec3 x = left.cross(z).normalized();
  Eigen::Matrix3d R;
  R << x, z.cross(x), z;
  return R;
}

/// Body rate, in the desired body frame, that keeps `R` on a force changing at `jerk` while the heading
/// turns. From z' = (jerk - (jerk z) z) / |force| and from x staying perpendicular to the heading's left.
Vec3 feedforward_rate(const Eigen::Matrix3d& R, const Vec3& force, const Vec3& jerk, double heading_rad,
                      double heading_rate_radps) {
  const Vec3 ahead(std::cos(heading_rad), std::sin(heading_rad), 0);
  const Vec3 left(-ahead.y(), ahead.x(), 0);
  const Vec3 turn = jerk / force.norm();
  const double wx = -turn.dot(R.col(1));
  const double wy = turn.dot(R.col(0));
  const double wz = (heading_rate_radps * ahead.dot(R.col(0)) + wy * left.dot(R.col(2))) / left.dot(R.col(1));
  return {wx, wy, wz};
}

/// Tilting comes first: it carries the vehicle; turning takes what is left of the rate limit.
Vec3 limited_rate(const Vec3& rate, double limit) {
  Vec3 out = at_most(Vec3(rate.x(), rate.y(), 0), limit);
  const double left = std::sqrt(std::max(0.0, limit * limit - out.squaredNorm()));
  out.z() = std::clamp(rate.z(), -left, left);
  return out;
}

}  // namespace

void describe(OptionTable& t, Se3Options& o) {
  t.add("position_gain", o.position_gain, "1/s^2", 0, 50, "acceleration for each metre of position error");
  t.add("velocity_gain", o.velocity_gain, "1/s", 0, 30, "acceleration for each m/s of velocity error");
  t.add("attitude_gain", o.attitude_gain, "1/s", 0.1, 40, "body rate for each radian of attitude error");
  t.add("world_integral_gain", o.world_integral_gain, "1/s^3", 0, 30,
        "growth of the disturbance held in the world frame, such as wind");
  t.add("body_integral_gain", o.body_integral_gain, "1/s^3", 0, 30,
        "growth of the disturbance held in the body frame, such as a shifted load");
  t.add("max_disturbance", o.max_disturbance_mps2, "m/s^2", 0, 9, "most that each disturbance may reach");
  t.add("max_tilt", o.max_tilt_rad, "rad", 0.05, 1.2, "most that the desired attitude leans");
}

Vec3 limited_force(const Vec3& wanted, double max_tilt_rad, double max_force_mps2) {
  Vec3 f = wanted;
  f.z() = std::clamp(f.z(), std::min(0.2 * kGravity, max_force_mps2), max_force_mps2);
  const double room = std::sqrt(std::max(0.0, max_force_mps2 * max_force_mps2 - f.z() * f.z()));
  f.head<2>() = at_most(Vec3(f.x(), f.y(), 0), std::min(f.z() * std::tan(max_tilt_rad), room)).head<2>();
  return f;
}

Se3Controller::Se3Controller(const Se3Options& options, double mass_kg, double max_thrust_n,
                             double max_body_rate_radps)
    : options_(options),
      mass_kg_(mass_kg),
      max_thrust_n_(max_thrust_n),
      max_body_rate_radps_(max_body_rate_radps) {}

void Se3Controller::reset() {
  world_disturbance_mps2_.setZero();
  body_disturbance_mps2_.setZero();
  disturbance_mps2_.setZero();
}

AttitudeRateCommand Se3Controller::update(const State& state, const Reference& reference, double dt_s) {
  const Eigen::Matrix3d R = state.orientation.toRotationMatrix();
  const Vec3 position_error = reference.position - state.position;
  const Vec3 velocity_error = reference.velocity_mps - state.velocity_mps;
  disturbance_mps2_ = world_disturbance_mps2_ + R * body_disturbance_mps2_;
  const Vec3 wanted = options_.position_gain * position_error + options_.velocity_gain * velocity_error +
                      reference.acceleration_mps2 - disturbance_mps2_ + kGravity * Vec3::UnitZ();
  const Vec3 force = limited_force(wanted, options_.max_tilt_rad, max_thrust_n_ / mass_kg_);

  // Anti-windup: what the limits cut off is no disturbance, so nothing is learned in its direction.
  const Vec3 cut = wanted - force;
  Vec3 lesson = position_error;
  if (const double n = cut.norm(); n > 1e-6) lesson -= std::max(0.0, lesson.dot(cut) / (n * n)) * cut;
  world_disturbance_mps2_ = at_most(world_disturbance_mps2_ - options_.world_integral_gain * dt_s * lesson,
                                    options_.max_disturbance_mps2);
  body_disturbance_mps2_ =
      at_most(body_disturbance_mps2_ - options_.body_integral_gain * dt_s * (R.transpose() * lesson),
              options_.max_disturbance_mps2);

  const Eigen::Matrix3d desired = attitude_of(force, reference.heading_rad);
  const Eigen::Matrix3d error = R.transpose() * desired;
  const Eigen::AngleAxisd rotation(error);
  const Vec3 rate = options_.attitude_gain * rotation.angle() * rotation.axis() +
                    error * feedforward_rate(desired, force, reference.jerk_mps3, reference.heading_rad,
                                             reference.heading_rate_radps);
  AttitudeRateCommand command;
  command.body_rate_radps = limited_rate(rate, max_body_rate_radps_);
  command.thrust_n = std::clamp(mass_kg_ * force.dot(R.col(2)), 0.0, max_thrust_n_);
  command.armed = true;
  return command;
}

}  // namespace karst::core
