// What the core tells the vehicle, a hundred times a second.
#pragma once
#include "core_stack/common/geometry.h"
#include "core_stack/common/time.h"

namespace karst::core {

/// The estimated motion of the vehicle.
struct State {
  TimeNs stamp = 0;
  Vec3 position = Vec3::Zero();         // world frame
  Vec3 velocity_mps = Vec3::Zero();     // world frame
  Quat orientation = Quat::Identity();  // body to world
  Vec3 body_rate_radps = Vec3::Zero();  // body frame
  Pose pose() const { return {position, orientation}; }
};

/// The motion to be flown, world frame.
struct Reference {
  TimeNs stamp = 0;
  Vec3 position = Vec3::Zero();
  Vec3 velocity_mps = Vec3::Zero();
  Vec3 acceleration_mps2 = Vec3::Zero();
  Vec3 jerk_mps3 = Vec3::Zero();
  double heading_rad = 0;
  double heading_rate_radps = 0;
};

/// Attitude rate in the body frame and collective thrust.
struct AttitudeRateCommand {
  Vec3 body_rate_radps = Vec3::Zero();
  double thrust_n = 0;
  bool armed = false;
};

/// The same motion in each form that an autopilot may take.
struct Command {
  AttitudeRateCommand rates;    // by the core's own controllers
  Reference reference;          // for an autopilot with controllers of its own
  State state;                  // for an autopilot without a position of its own
  bool state_is_known = false;  // false: the core does not know where it is, or only guesses
};

}  // namespace karst::core
