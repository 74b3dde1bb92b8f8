// A vehicle whose autopilot is reached by MAVLink. The autopilot tells of its sensors, its mode and its
// failsafes, and flies what the core commands while the pilot has handed over.
#pragma once
#include <deque>
#include <memory>
#include <utility>

#include "plugins/mavlink/command_queue.h"
#include "plugins/mavlink/connection.h"
#include "plugins/mavlink/held_messages.h"
#include "plugins/mavlink/mavlink_options.h"
#include "plugins/mavlink/scan_source.h"
#include "plugins/mavlink/telemetry.h"

namespace karst::mavlink {

class MavlinkVehicle final : public core::Vehicle {
 public:
  /// What a vehicle consists of. `climb_m`: by which it will rise from where it stands; `run_dir`: for the
  /// record of the link's traffic, "" for none.
  struct Parts {
    core::VehicleDescription description;
    std::unique_ptr<ByteLink> link;
    std::unique_ptr<ScanSource> scans;  // may be null
    double climb_m = 1.5;
    std::string run_dir;
    std::string address = {};  // of the link, for persons; "" if it has none
  };
  MavlinkVehicle(const MavlinkOptions& options, Parts parts);

  core::VehicleDescription description() const override { return description_; }
  void start(core::Executive& executive, core::VehicleSink& sink) override;
  void command(const core::Command& command) override;
  std::vector<core::VehicleCheck> checks() const override;
  void finish() override;

  /// A message of another sensor, which waits for the IMU as the scans do.
  void hold(core::TimeNs stamp, std::function<void()> deliver) {
    held_.hold(stamp, now(), std::move(deliver));
  }
  const Connection& connection() const { return connection_; }
  const ClockSync& clock() const { return clock_; }

 private:
  core::TimeNs now() const { return executive_->now(); }
  void step();
  void take(const Frame& frame);
  void take_ack(const CommandAck& m);
  void answer(const Timesync& m, core::TimeNs measured);
  void report_steering();
  void keep_in_touch();
  void ask_for_telemetry();
  void ask_for_setpoint_mode();
  void lift_off(const core::Command& command);
  void disarm_on_ground();
  bool due(core::TimeNs& last, double rate_hz) const;
  template <class Message>
  Message addressed(Message m) const {
    m.target_system = connection_.peer().system;
    m.target_component = connection_.peer().component;
    return m;
  }
  void add_command(Cmd number, std::array<float, 7> parameters, CommandQueue::Done done = {});

  MavlinkOptions options_;
  core::VehicleDescription description_;
  Connection connection_;
  std::unique_ptr<ScanSource> scans_;
  double climb_m_;
  std::string run_dir_, address_;
  ClockSync clock_;
  CommandQueue commands_;
  ParameterReader parameters_;
  HandOver hand_over_;
  Telemetry telemetry_;
  HeldMessages held_;
  std::deque<std::pair<core::TimeNs, Frame>> arrived_;  // with the measured time, oldest first
  core::TimeNs lost_time_ = 0;                          // of the executive

  core::Executive* executive_ = nullptr;
  core::VehicleSink* sink_ = nullptr;
  core::TimeNs started_ = 0;
  HandOver::Steering reported_;
  core::State state_;  // as commanded last, and whether it is known
  bool state_known_ = false;
  std::uint8_t pose_resets_ = 0;  // jumps of the state
  bool commanded_ = false;        // ever
  std::optional<core::TimeNs> streams_since_, setpoint_at_;
  // When each was sent last.
  core::TimeNs heartbeat_at_, timesync_at_, vision_at_, target_at_, telemetry_at_, take_off_at_, disarm_at_;
  bool flown_ = false, landed_ = false;  // by the core
  std::uint64_t imu_before_ = 0;         // samples when telemetry was asked for
};

}  // namespace karst::mavlink
