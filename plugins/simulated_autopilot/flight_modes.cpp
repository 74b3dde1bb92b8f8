#include "plugins/simulated_autopilot/flight_modes.h"

#include <utility>

namespace karst::sim {
namespace {

using core::kSecond;
using core::TimeNs;
using mavlink::CmdResult;

constexpr TimeNs kOffboardLoss = kSecond;                       // COM_OF_LOSS_T
constexpr TimeNs kGuidedTimeout = 3 * kSecond;                  // GUID_TIMEOUT
constexpr TimeNs kDisarmAfter = kSecond;                        // on the ground, in land
constexpr std::uint8_t kCritical = 2, kWarning = 4, kInfo = 6;  // MAV_SEVERITY

}  // namespace

void describe(core::OptionTable& t, AutopilotFirmwareOptions& o) {
  t.add("firmware", o.firmware, "in whose manner the autopilot behaves");
  t.add("pilot", o.pilot, {},
        "what the pilot does: seconds and arm, disarm, hand_over, take_over, hold or land, separated by "
        "commas");
  t.add("answer_delay", o.answer_delay_s, "s", 0, 10, "of the answers to commands, on top of the link's");
  t.add("refuse_offboard_until", o.refuse_offboard_until_s, "s", 0, 86400,
        "until then it grants neither offboard nor guided");
  t.add("offboard_loss", o.offboard_loss, "what PX4 does when setpoints stop");
  t.add("battery_failsafe", o.battery_failsafe, "", 0, 1,
        "it lands when so much of the battery is left; 0: never");
  t.add("clock_offset", o.clock_offset_s, "s", -1e6, 1e6, "of the autopilot's clock against the core's");
  t.add("clock_drift_ppm", o.clock_drift_ppm, "", -500, 500, "how much faster its clock runs, in 1e-6");
  t.add("other_system", o.other_system, "another vehicle, with another number, speaks on the link as well");
  t.add("unhealthy", o.unhealthy, {},
        "which of its sensors it says are unhealthy, with spaces between: gyroscope, accelerometer, "
        "magnetometer, barometer, battery, transmitter");
  t.add("parameters", o.parameters, {},
        "\"NAME=VALUE NAME=VALUE\": parameters that are not as they should be");
}

void FlightModes::enter(FlightMode mode, bool failsafe) {
  mode_ = mode;
  failsafe_ = failsafe;
  target_timed_out_ = false;
  landed_at_.reset();
}

void FlightModes::fail_safe(FlightMode mode, const std::string& why) {
  say(kCritical, "Failsafe: " + why);
  enter(mode, true);
}

CmdResult FlightModes::arm(const ModeInputs& in) {
  if (armed_) return CmdResult::accepted;
  if (!in.position_known) {
    say(kWarning, px4() ? "Arming denied: no valid position" : "PreArm: VisOdom: not healthy");
    return CmdResult::temporarily_rejected;
  }
  armed_ = true;
  say(kInfo, "Armed");
  return CmdResult::accepted;
}

CmdResult FlightModes::disarm(const ModeInputs& in) {
  if (!in.standing) return CmdResult::denied;
  armed_ = false;
  failsafe_ = false;
  say(kInfo, "Disarmed");
  return CmdResult::accepted;
}

CmdResult FlightModes::select(FlightMode mode, const ModeInputs& in) {
  if (mode != FlightMode::guided) {
    enter(mode, false);
    return CmdResult::accepted;
  }
  if (in.now < core::from_seconds(options_.refuse_offboard_until_s)) return CmdResult::denied;
  if (!in.position_known) return CmdResult::temporarily_rejected;
  if (px4()) {
    const bool streaming = in.setpoint_at && in.now - *in.setpoint_at < kSecond / 2 && in.streams_since &&
                           in.now - *in.streams_since >= kSecond;
    if (!streaming) {
      say(kWarning, "Offboard denied: no setpoints");
      return CmdResult::temporarily_rejected;
    }
  }
  enter(FlightMode::guided, false);
  return CmdResult::accepted;
}

void FlightModes::step(const ModeInputs& in) {
  if (!armed_) return;
  if (in.battery_fraction < options_.battery_failsafe && !battery_acted_) {
    battery_acted_ = true;
    fail_safe(FlightMode::land, "critical battery, landing");
  }
  if (mode_ == FlightMode::guided) {
    const bool fresh = in.setpoint_at && in.now - *in.setpoint_at <= (px4() ? kOffboardLoss : kGuidedTimeout);
    if (px4() && !fresh)
      fail_safe(options_.offboard_loss == OffboardLoss::land ? FlightMode::land : FlightMode::hold,
                "offboard control signal lost");
    else
      target_timed_out_ = !fresh;
  }
  if (!in.position_known && !in.standing && mode_ != FlightMode::land)
    fail_safe(FlightMode::land, px4() ? "no valid position, descending" : "EKF variance, landing");
  if (mode_ == FlightMode::land && in.standing) {
    if (!landed_at_) landed_at_ = in.now;
    if (in.now - *landed_at_ >= kDisarmAfter) disarm(in);
  }
}

std::uint32_t FlightModes::custom_mode() const {
  switch (mode_) {
    case FlightMode::position:
      return px4() ? 3u << 16 : 5;
    case FlightMode::hold:
      return px4() ? 4u << 16 | 3u << 24 : 17;
    case FlightMode::guided:
      return mavlink::setpoint_mode(options_.firmware);
    case FlightMode::land:
      return px4() ? 4u << 16 | 6u << 24 : 9;
  }
  return 0;
}

std::uint8_t FlightModes::system_status() const {
  if (failsafe_) return mavlink::kCritical;
  return armed_ ? mavlink::kActive : mavlink::kStandby;
}

}  // namespace karst::sim
