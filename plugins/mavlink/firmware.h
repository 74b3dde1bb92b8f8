// What PX4 and ArduPilot (copters) do differently: the numbers of their modes, and the parameters that must
// hold. Sources: https://docs.px4.io (px4_custom_mode.h), https://ardupilot.org/copter/docs/flight-modes.html
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core_stack/common/enum_names.h"

namespace karst::mavlink {

enum class Firmware { px4, ardupilot };
constexpr auto names_of(Firmware) {
  using enum Firmware;
  return std::to_array<core::Named<Firmware>>({{px4, "px4"}, {ardupilot, "ardupilot"}});
}

/// Who flies in a mode: setpoints from outside, the pilot's sticks, or the autopilot by itself.
enum class FlownBy { setpoints, sticks, itself };

struct Mode {
  std::string name;
  FlownBy flown_by = FlownBy::sticks;
};

/// HEARTBEAT.custom_mode.
Mode mode_of(Firmware firmware, std::uint32_t custom_mode);
/// Offboard of PX4, guided of ArduPilot.
std::uint32_t setpoint_mode(Firmware firmware);

/// MAV_AUTOPILOT of the heartbeat.
std::uint8_t autopilot_number(Firmware firmware);

/// HEARTBEAT.base_mode: armed, and a custom mode is given.
constexpr std::uint8_t kArmed = 0x80, kCustomMode = 0x01;
/// HEARTBEAT.system_status (MAV_STATE): from here on a failsafe acts.
constexpr std::uint8_t kStandby = 3, kActive = 4, kCritical = 5;

}  // namespace karst::mavlink
