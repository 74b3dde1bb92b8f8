// Battery: the power drawn in flight and the energy left.
#pragma once
#include "core_stack/vehicle/messages.h"
#include "plugins/simulator/dynamics/motors.h"

namespace karst::sim {

struct BatteryOptions {
  double minutes = 10;         // of hovering on a full battery
  double hover_power_w = 300;  // total, avionics included
  double avionics_w = 30;      // computer and sensors, drawn on the ground as well
};
void describe(core::OptionTable& t, BatteryOptions& o);

/// Electric power. Momentum theory: induced power grows with thrust^1.5, scaled to give `hover_power_w` when
/// four motors carry the weight; the power of air drag is added at 60 % efficiency.
double power_w(const BatteryOptions& o, const BodyModel& body, const MotorThrusts& f, double airspeed_mps);

class Battery {
 public:
  explicit Battery(const BatteryOptions& o);
  /// The mean that predicts the time left follows airborne power only: time on the ground must not predict a
  /// longer flight.
  void drain(double power_w, double dt_s, bool airborne);
  bool empty() const { return energy_left_wh_ <= 0; }
  core::BatteryStatus status(core::TimeNs stamp) const;

 private:
  double capacity_wh_, energy_left_wh_;
  double mean_power_w_, power_w_ = 0;
};

}  // namespace karst::sim
