// Geometric tracking on SE(3) (Lee, Leok, McClamroch, CDC 2010) with disturbance terms in world and body
// frames; gives attitude rate and thrust to the autopilot.
#pragma once
#include "core_stack/control/mpc_tracker.h"
#include "core_stack/vehicle/messages.h"

namespace karst::core {

struct Se3Options {
  double position_gain = 6.0;       // 1/s^2
  double velocity_gain = 4.0;       // 1/s
  double attitude_gain = 8.0;       // rad/s per rad
  double world_integral_gain = 1.0; // 1/s^3
  double body_integral_gain = 0.5;
  double max_disturbance_mps2 = 3.0;
  double max_tilt_rad = 0.6;
};
void describe(OptionTable& t, Se3Options& o);

class Se3Controller {
 public:
  Se3Controller(const Se3Options& options, double mass_kg, double max_thrust_n, double max_body_rate_radps);
  void reset();
  AttitudeRateCommand update(const State& state, const Reference& reference, double dt_s);
  Vec3 disturbance_mps2() const;  // world frame, as estimated

 private:
  // the implementer's
};

}  // namespace karst::core
