// The autopilot's modes: which one it is in, what it refuses, and its failsafes, in the manner of PX4 or
// ArduPilot.
//
//   PX4        offboard is granted after a second of setpoints, and left for hold or land when they stop
//              (COM_OF_LOSS_T, COM_OBL_RC_ACT).
//   ArduPilot  guided is granted if the position is known; when targets stop it hovers there (GUID_TIMEOUT).
//   Without
//              vision the EKF failsafe lands.
#pragma once
#include <deque>
#include <optional>
#include <string>

#include "plugins/mavlink/command_queue.h"
#include "plugins/simulated_autopilot/autopilot_options.h"

namespace karst::sim {

/// position: by the pilot's sticks.
enum class FlightMode { position, hold, guided, land };

/// What the modes depend on.
struct ModeInputs {
  core::TimeNs now = 0;
  bool position_known = false, standing = true;
  std::optional<core::TimeNs> setpoint_at, streams_since;  // of the newest, and of the first without a gap
  double battery_fraction = 1;
};

class FlightModes {
 public:
  explicit FlightModes(const AutopilotFirmwareOptions& options) : options_(options) {}

  /// Failsafes, and what ends by itself.
  void step(const ModeInputs& in);
  mavlink::CmdResult arm(const ModeInputs& in);
  /// Refused in the air.
  mavlink::CmdResult disarm(const ModeInputs& in);
  mavlink::CmdResult select(FlightMode mode, const ModeInputs& in);

  bool armed() const { return armed_; }
  FlightMode mode() const { return mode_; }
  /// Guided without a target that is new enough: ArduPilot stops and hovers.
  bool target_timed_out() const { return target_timed_out_; }
  /// HEARTBEAT.custom_mode and system_status.
  std::uint32_t custom_mode() const;
  std::uint8_t system_status() const;
  /// Texts for the ground since the last call, each with its severity.
  std::deque<std::pair<std::uint8_t, std::string>> take_texts() { return std::exchange(texts_, {}); }

 private:
  void say(std::uint8_t severity, std::string text) { texts_.emplace_back(severity, std::move(text)); }
  void enter(FlightMode mode, bool failsafe);
  void fail_safe(FlightMode mode, const std::string& why);
  bool px4() const { return options_.firmware == mavlink::Firmware::px4; }

  AutopilotFirmwareOptions options_;
  FlightMode mode_ = FlightMode::position;
  bool armed_ = false, failsafe_ = false, battery_acted_ = false, target_timed_out_ = false;
  std::optional<core::TimeNs> landed_at_;
  std::deque<std::pair<std::uint8_t, std::string>> texts_;
};

}  // namespace karst::sim
