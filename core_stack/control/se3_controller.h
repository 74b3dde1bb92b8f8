// Geometric tracking on SE(3) (Lee, Leok, McClamroch, CDC 2010) with disturbance terms in world and body
// frames; gives attitude rate and thrust to the autopilot.
#pragma once
#include "core_stack/control/mpc_tracker.h"
#include "core_stack/vehicle/command.h"

namespace karst::core {

struct Se3Options {
  double position_gain = 12.0;        // 1/s^2
  double velocity_gain = 6.5;         // 1/s
  double attitude_gain = 12.0;        // rad/s per rad
  double world_integral_gain = 10.0;  // 1/s^3
  double body_integral_gain = 2.0;    // 1/s^3
  double max_disturbance_mps2 = 3.0;
  double max_tilt_rad = 0.6;
};
void describe(OptionTable& t, Se3Options& o);

class Se3Controller {
 public:
  Se3Controller(const Se3Options& options, double mass_kg, double max_thrust_n, double max_body_rate_radps);
  /// Forgets the disturbances: on the ground errors say nothing about the air.
  void reset();
  void set_mass_kg(double mass_kg) { mass_kg_ = mass_kg; }
  AttitudeRateCommand update(const State& state, const Reference& reference, double dt_s);
  Vec3 disturbance_mps2() const { return disturbance_mps2_; }  // world frame, as estimated

 private:
  Se3Options options_;
  double mass_kg_, max_thrust_n_, max_body_rate_radps_;
  Vec3 world_disturbance_mps2_ = Vec3::Zero();
  Vec3 body_disturbance_mps2_ = Vec3::Zero();
  Vec3 disturbance_mps2_ = Vec3::Zero();
};

/// The specific force nearest to `wanted_mps2` that keeps the vehicle upright: at least a fifth of gravity
/// upwards, tilt and thrust within limits. The vertical part comes first, the horizontal takes what is left.
Vec3 limited_force(const Vec3& wanted_mps2, double max_tilt_rad, double max_force_mps2);

}  // namespace karst::core
