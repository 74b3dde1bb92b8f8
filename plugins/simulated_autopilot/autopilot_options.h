// Options of the simulated autopilot.
#pragma once
#include <string>

#include "core_stack/common/options.h"
#include "plugins/mavlink/firmware.h"

namespace karst::sim {

/// What PX4 does when setpoints stop.
enum class OffboardLoss { hold, land };
constexpr auto names_of(OffboardLoss) {
  using enum OffboardLoss;
  return std::to_array<core::Named<OffboardLoss>>({{hold, "hold"}, {land, "land"}});
}

struct AutopilotFirmwareOptions {
  mavlink::Firmware firmware = mavlink::Firmware::px4;
  std::string pilot = "2 arm, 4 hand_over";
  double answer_delay_s = 0;  // of commands
  double refuse_offboard_until_s = 0;
  OffboardLoss offboard_loss = OffboardLoss::hold;
  double battery_failsafe = 0;  // fraction at which it lands
  double clock_offset_s = 1234.5, clock_drift_ppm = 20;
  bool other_system = false;    // another vehicle speaks on the link
  std::string unhealthy = {};   // names of its sensors, "gyroscope transmitter"
  std::string parameters = {};  // "NAME=VALUE NAME=VALUE": that differ from what should be
};
void describe(core::OptionTable& t, AutopilotFirmwareOptions& o);

}  // namespace karst::sim
