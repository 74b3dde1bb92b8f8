// The autopilot's attitude-rate controller, between the core stack's command and the motors.
#pragma once
#include <optional>

#include "core_stack/vehicle/command.h"
#include "plugins/simulator/dynamics/motors.h"

namespace karst::sim {

struct AutopilotOptions {
  // With a motor lag tau the loop is second order with damping 1 / (2 sqrt(gain tau)): 0.71 for 20 1/s.
  double rate_gain_1ps = 20;
  double yaw_rate_gain_1ps = 8;
  double max_body_rate_radps = 6;
};
void describe(core::OptionTable& t, AutopilotOptions& o);

/// Thrust and torque to command from the motors: torque = J K (w_commanded - w) + w x J w. Commands that are
/// not finite or not armed give zero.
Wrench rate_control(const AutopilotOptions& o, const BodyModel& body,
                    const core::AttitudeRateCommand& command, const core::Vec3& measured_rate_radps);

/// The autopilot's command when no more commands come: it levels the vehicle and sinks at `sink_mps`. With a
/// horizontal velocity (world frame) it brakes by up to 2 m/s^2; without one, or a position, the vehicle
/// drifts. It uses its own attitude and climb rate, and the hover thrust `weight_n` that it has learned.
core::AttitudeRateCommand level_descent(const BodyState& s, double weight_n,
                                        const std::optional<core::Vec3>& velocity_mps, double sink_mps);

}  // namespace karst::sim
