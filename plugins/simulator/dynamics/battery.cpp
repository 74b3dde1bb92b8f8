#include "plugins/simulator/dynamics/battery.h"

#include <algorithm>
#include <cmath>

namespace karst::sim {

void describe(core::OptionTable& t, BatteryOptions& o) {
  t.add("battery_minutes", o.minutes, "min", 0.1, 240, "hovering time of a full battery");
  t.add("hover_power", o.hover_power_w, "W", 10, 5000, "power drawn in hover, all in");
  t.add("avionics_power", o.avionics_w, "W", 0, 500,
        "power of computer and sensors, drawn on the ground as well");
}

double power_w(const BatteryOptions& o, const BodyModel& body, const MotorThrusts& f, double airspeed_mps) {
  constexpr double kEfficiency = 0.6;
  const double induced_at_hover = 4 * std::pow(body.weight_n() / 4, 1.5);
  const double induced = (f.array() * f.array().sqrt()).sum();
  const double hover_w = std::max(o.hover_power_w - o.avionics_w, 0.0);
  return o.avionics_w + hover_w * induced / induced_at_hover +
         body.drag_kgps * airspeed_mps * airspeed_mps / kEfficiency * (induced > 0);
}

Battery::Battery(const BatteryOptions& o)
    : capacity_wh_(o.hover_power_w * o.minutes / 60),
      energy_left_wh_(capacity_wh_),
      mean_power_w_(o.hover_power_w) {}

void Battery::drain(double power_w, double dt_s, bool airborne) {
  constexpr double kMemory_s = 20;
  power_w_ = power_w;
  energy_left_wh_ = std::max(energy_left_wh_ - power_w * dt_s / 3600, 0.0);
  if (airborne) mean_power_w_ += (power_w - mean_power_w_) * std::min(dt_s / kMemory_s, 1.0);
}

core::BatteryStatus Battery::status(core::TimeNs stamp) const {
  return {stamp, energy_left_wh_, energy_left_wh_ / capacity_wh_, power_w_,
          energy_left_wh_ * 3600 / mean_power_w_};
}

}  // namespace karst::sim
