// All options of a vehicle that is flown by MAVLink.
#pragma once
#include "core_stack/common/options.h"
#include "plugins/mavlink/hand_over.h"
#include "plugins/mavlink/parameters.h"

namespace karst::mavlink {

struct MavlinkOptions {
  std::string link = "udp:14540";
  Firmware firmware = Firmware::px4;
  Control control = Control::position;
  Engage engage = Engage::pilot;
  Resume resume = Resume::after_link_loss;
  std::int64_t system = 1;
  double setpoint_rate_hz = 50, vision_rate_hz = 40, imu_rate_hz = 200;
  double hover_thrust = 0.5;
  double battery_wh = 50;
};
void describe(core::OptionTable& t, MavlinkOptions& o);

/// What the autopilot cannot tell of the body that it flies.
struct BodyOptions {
  double mass_kg = 2, radius_m = 0.3, max_thrust_n = 43, max_body_rate_radps = 6;
};
void describe(core::OptionTable& t, BodyOptions& o);

}  // namespace karst::mavlink
