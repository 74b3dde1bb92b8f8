#include "plugins/simulator/autopilot.h"

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

}  // namespace karst::sim
