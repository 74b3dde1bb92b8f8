#include "plugins/simulator/dynamics/motors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace karst::sim {
namespace {

// Signs of each motor's position (x forward, y left) and of its reaction torque.
const MotorThrusts kForward(1, 1, -1, -1), kLeft(1, -1, 1, -1), kSpin(1, -1, -1, 1);

}  // namespace

void describe(core::OptionTable& t, MotorModel& m) {
  t.add("thrust_to_weight", m.thrust_to_weight, "", 1.2, 10, "greatest collective thrust over weight");
  t.add("arm", m.arm_m, "m", 0.03, 2, "from the vehicle's centre to each motor");
  t.add("yaw_moment", m.yaw_moment_m, "m", 0.001, 0.2, "a motor's reaction torque over its thrust");
  t.add("time_constant", m.time_constant_s, "s", 0.001, 0.5, "first-order lag of the thrust");
  t.add("weak", m.weak, 0, 4,
        "number of a worn motor: 1 front left, 2 front right, 3 rear left, 4 rear right; 0: none");
  t.add("weak_fraction", m.weak_fraction, "", 0, 1, "of the thrust asked of it that a worn motor exerts");
  t.add("weak_after", m.weak_after_s, "s", 0, 86400, "when it begins to be worn");
}

double max_motor_thrust_n(const MotorModel& motors, const BodyModel& body) {
  return motors.thrust_to_weight * body.weight_n() / 4;
}

Wrench wrench_of(const MotorModel& model, const MotorThrusts& f) {
  const double lever = model.arm_m / std::numbers::sqrt2;
  return {f.sum(), {lever * kLeft.dot(f), -lever * kForward.dot(f), model.yaw_moment_m * kSpin.dot(f)}};
}

MotorThrusts mix(const MotorModel& model, double max_n, const Wrench& wanted) {
  const double lever = model.arm_m / std::numbers::sqrt2;
  const MotorThrusts yaw = wanted.torque_nm.z() / (4 * model.yaw_moment_m) * kSpin;
  MotorThrusts tilt = (wanted.torque_nm.x() * kLeft - wanted.torque_nm.y() * kForward) / (4 * lever);
  const MotorThrusts exact = tilt.array() + yaw.array() + wanted.thrust_n / 4;
  if (exact.minCoeff() >= 0 && exact.maxCoeff() <= max_n) return exact;

  const double span = tilt.maxCoeff() - tilt.minCoeff();
  if (span > max_n) tilt *= max_n / span;
  const double collective = std::clamp(wanted.thrust_n / 4, -tilt.minCoeff(), max_n - tilt.maxCoeff());
  const MotorThrusts f = tilt.array() + collective;
  double fraction = 1;
  for (int i = 0; i < 4; ++i) {
    if (yaw[i] > 0) fraction = std::min(fraction, (max_n - f[i]) / yaw[i]);
    if (yaw[i] < 0) fraction = std::min(fraction, f[i] / -yaw[i]);
  }
  return (f + std::max(fraction, 0.0) * yaw).cwiseMax(0.0).cwiseMin(max_n);
}

MotorThrusts exerted(const MotorModel& model, const MotorThrusts& f, double t_s) {
  MotorThrusts out = f;
  if (model.weak > 0 && t_s >= model.weak_after_s) out[model.weak - 1] *= model.weak_fraction;
  return out;
}

MotorThrusts follow(const MotorModel& model, const MotorThrusts& f, const MotorThrusts& commanded,
                    double dt_s) {
  return commanded + std::exp(-dt_s / model.time_constant_s) * (f - commanded);
}

}  // namespace karst::sim
