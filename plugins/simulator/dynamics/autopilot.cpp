#include "plugins/simulator/dynamics/autopilot.h"

#include <algorithm>
#include <cmath>

namespace karst::sim {

using core::Vec3;

void describe(core::OptionTable& t, AutopilotOptions& o) {
  t.add("rate_gain", o.rate_gain_1ps, "1/s", 1, 200, "roll and pitch acceleration over rate error");
  t.add("yaw_rate_gain", o.yaw_rate_gain_1ps, "1/s", 1, 200, "yaw acceleration over rate error");
  t.add("max_body_rate", o.max_body_rate_radps, "rad/s", 0.5, 30, "commanded body rates are limited to this");
}

Wrench rate_control(const AutopilotOptions& o, const BodyModel& body,
                    const core::AttitudeRateCommand& command, const Vec3& measured_rate_radps) {
  if (!command.armed || !command.body_rate_radps.allFinite() || !std::isfinite(command.thrust_n)) return {};
  const double limit = o.max_body_rate_radps;
  const Vec3 wanted = command.body_rate_radps.cwiseMax(-limit).cwiseMin(limit);
  const Vec3& w = measured_rate_radps;
  const Vec3 J = body.inertia_kgm2();
  const Vec3 gain(o.rate_gain_1ps, o.rate_gain_1ps, o.yaw_rate_gain_1ps);
  const Vec3 acceleration = gain.cwiseProduct(wanted - w);
  return {std::max(command.thrust_n, 0.0), J.cwiseProduct(acceleration) + w.cross(J.cwiseProduct(w))};
}

core::AttitudeRateCommand level_descent(const BodyState& s, double weight_n,
                                        const std::optional<Vec3>& velocity_mps, double sink_mps) {
  constexpr double kLevelling_1ps = 6, kClimbRateGain_1ps = 3;
  constexpr double kBraking_1ps = 1.5, kMaxBraking_mps2 = 2;
  const core::Quat to_body = s.T_world_body.orientation.conjugate();
  const Vec3 up_body = to_body * Vec3::UnitZ();
  Vec3 thrust_world = kGravity_mps2 * Vec3::UnitZ();
  if (velocity_mps) {
    const Vec3 braking = -kBraking_1ps * Vec3(velocity_mps->x(), velocity_mps->y(), 0);
    thrust_world += braking * std::min(1.0, kMaxBraking_mps2 / std::max(braking.norm(), 1e-9));
  }
  const double force = 1 + kClimbRateGain_1ps * (-sink_mps - s.velocity_mps.z()) / kGravity_mps2;
  core::AttitudeRateCommand out;
  out.body_rate_radps = kLevelling_1ps * Vec3::UnitZ().cross(to_body * thrust_world.normalized());
  out.thrust_n = weight_n * std::clamp(force, 0.3, 1.5) / std::clamp(up_body.z(), 0.5, 1.0);
  out.armed = true;
  return out;
}

}  // namespace karst::sim
