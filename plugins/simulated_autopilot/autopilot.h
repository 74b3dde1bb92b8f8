// The simulated autopilot: it estimates its motion, flies what it is told, and speaks MAVLink.
#pragma once
#include <map>

#include "core_stack/vehicle/vehicle.h"
#include "plugins/mavlink/clock_sync.h"
#include "plugins/mavlink/connection.h"
#include "plugins/simulated_autopilot/flight_control.h"
#include "plugins/simulated_autopilot/flight_modes.h"
#include "plugins/simulated_autopilot/pilot_script.h"

namespace karst::sim {

/// What the autopilot knows of the body that it flies.
struct AutopilotBody {
  double hover_thrust = 0.45;  // normalized
  double max_thrust_n = 43;
};

class Autopilot {
 public:
  /// Throws InputError on a script or parameters that cannot be read.
  Autopilot(const AutopilotFirmwareOptions& options, const AutopilotBody& body,
            std::unique_ptr<mavlink::ByteLink> link);

  // Its sensors; body frame FLU, as the simulator gives them.
  void on_magnetometer(const core::MagnetometerSample& s) { magnetometer_ = s; }
  void on_barometer(const core::BarometerSample& s) { barometer_ = s; }
  void on_battery(const core::BatteryStatus& s) { battery_ = s; }
  void on_ground(bool standing) { standing_ = standing; }

  /// One cycle, for each sample of the IMU: gives what the motors are to do.
  core::AttitudeRateCommand step(const core::ImuSample& imu);

  /// Acts now, besides the script.
  void pilot(PilotAction action) { pilot_tries_ = PilotStep{now_, action}; }

  const FlightModes& modes() const { return modes_; }
  const Motion& motion() const { return observer_.motion(); }

 private:
  struct Answer {
    core::TimeNs at;
    mavlink::CommandAck ack;
  };

  core::TimeNs own_time(core::TimeNs time) const;
  bool position_known() const;
  ModeInputs inputs() const;
  void take(const mavlink::Frame& frame);
  void take_vision(const mavlink::Odometry& m);
  void take_command(const mavlink::CommandLong& m);
  mavlink::CmdResult carry_out(const mavlink::CommandLong& m);
  void answer_parameter(const mavlink::ParamRequestRead& m);
  void note_setpoint();
  void play_pilot();
  RateTarget control(double dt_s);
  RateTarget follow_setpoints(double dt_s);
  void hover_here(core::Vec3 velocity_mps);
  void report();
  bool due(std::uint32_t message);
  void report_imu();
  void report_system();
  void report_motion();

  AutopilotFirmwareOptions options_;
  AutopilotBody body_;
  std::vector<PilotStep> script_;
  std::map<std::string, double> parameters_;
  std::uint32_t healthy_sensors_;
  mavlink::Connection connection_;
  mavlink::ClockSync clock_;  // of the computer that karst runs on, in this clock
  Observer observer_;
  FlightModes modes_;
  FlightControl control_;

  core::TimeNs now_ = 0;
  core::ImuSample imu_;
  core::MagnetometerSample magnetometer_;
  core::BarometerSample barometer_;
  core::BatteryStatus battery_;
  bool standing_ = true;

  std::optional<core::TimeNs> setpoint_at_, streams_since_;
  std::optional<RateTarget> rate_target_;  // the newest of either kind
  std::optional<PositionTarget> position_target_;
  PositionTarget hover_;  // in hold, land and under the pilot's hands
  FlightMode flown_ = FlightMode::position;
  bool timed_out_ = false, takes_off_ = false;
  double take_off_m_ = 0;

  std::vector<PilotStep>::const_iterator pilot_;
  std::optional<PilotStep> pilot_tries_;  // again each second, until it is granted
  std::deque<Answer> answers_;
  std::map<std::uint32_t, core::TimeNs> periods_, sent_at_;
};

}  // namespace karst::sim
