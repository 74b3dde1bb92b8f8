// The autopilot's cascade: position and velocity to a thrust vector, that and a yaw to body rates, NED and
// FRD. Gains are PX4's defaults for a multicopter (MPC_XY_P, MPC_XY_VEL_P_ACC, MC_ROLL_P ...).
#pragma once
#include <optional>

#include "plugins/simulated_autopilot/observer.h"

namespace karst::sim {

/// What a position controller follows, NED. Without a position only the velocity counts.
struct PositionTarget {
  std::optional<core::Vec3> position;
  core::Vec3 velocity_mps = core::Vec3::Zero(), acceleration_mps2 = core::Vec3::Zero();
  double yaw_rad = 0, yaw_rate_radps = 0;
};

/// Body rates (FRD), and thrust from 0 to 1.
struct RateTarget {
  core::Vec3 rate_radps = core::Vec3::Zero();
  double thrust = 0;
};

double yaw_of(const core::Quat& attitude);

class FlightControl {
 public:
  /// `hover_thrust`: that carries the vehicle, as the autopilot believes.
  explicit FlightControl(double hover_thrust) : hover_thrust_(hover_thrust) {}

  RateTarget follow(const PositionTarget& target, const Motion& motion, double dt_s);
  /// Level, with that climb rate, where the position is not known: it drifts.
  RateTarget level(double climb_mps, const Motion& motion, double dt_s);
  void reset() { integral_mps2_.setZero(); }

 private:
  RateTarget turn_to(const core::Vec3& force_mps2, double yaw_rad, double yaw_rate_radps,
                     const Motion& motion) const;

  double hover_thrust_;
  core::Vec3 integral_mps2_ = core::Vec3::Zero();
};

}  // namespace karst::sim
