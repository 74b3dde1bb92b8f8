#include "plugins/mavlink/mavlink_vehicle.h"

#include <cmath>
#include <cstdio>

#include "plugins/mavlink/link_record.h"
#include "plugins/mavlink/ned.h"
#include "plugins/mavlink/sensor_health.h"
#include "plugins/mavlink/setpoints.h"

namespace karst::mavlink {
namespace {

using core::Authority;
using core::kMillisecond;
using core::kSecond;
using core::TimeNs;

constexpr TimeNs kStep = 5 * kMillisecond;
constexpr double kHeartbeat_hz = 1, kTimesync_hz = 10, kTakeOffAgain_hz = 0.5, kDisarmAgain_hz = 2,
                 kTelemetryAgain_hz = 0.2;
constexpr double kGravity_mps2 = 9.81;
/// PX4 grants offboard after a second of setpoints.
constexpr TimeNs kStreamFirst = kSecond + 200 * kMillisecond, kStreamBroken = kSecond / 2;
constexpr TimeNs kTooLate = 100 * kMillisecond;  // of the loop, for a command
constexpr double kJump_m = 0.5;                  // between two states 10 ms apart: localization was corrected
constexpr TimeNs kNever = -3600 * kSecond;       // long before the start
/// There and back, up to which the form of control was flown (docs/results/mavlink_flights.md).
constexpr double kMaxRoundTrip_ms = 210, kMaxRatesRoundTrip_ms = 30;

std::string text(const char* format, double value) {
  char out[60];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

}  // namespace

MavlinkVehicle::MavlinkVehicle(const MavlinkOptions& o, Parts parts)
    : options_(o),
      description_(std::move(parts.description)),
      connection_(std::move(parts.link), {static_cast<std::uint8_t>(o.system), kOnboardComputer},
                  autopilot_of(o.system)),
      scans_(std::move(parts.scans)),
      climb_m_(parts.climb_m),
      run_dir_(std::move(parts.run_dir)),
      address_(std::move(parts.address)),
      parameters_(rules_of(o.firmware, o.control, o.hover_thrust), o.firmware),
      hand_over_(o.firmware, o.engage, o.resume),
      telemetry_(o.battery_wh),
      heartbeat_at_(kNever),
      timesync_at_(kNever),
      vision_at_(kNever),
      target_at_(kNever),
      telemetry_at_(kNever),
      take_off_at_(kNever),
      disarm_at_(kNever) {
  description_.authority = Authority::pilot;
  description_.takes_reference = o.control == Control::position;
  if (scans_) description_.lidar = scans_->model();
}

void MavlinkVehicle::start(core::Executive& executive, core::VehicleSink& sink) {
  executive_ = &executive;
  sink_ = &sink;
  started_ = now();
  executive.every("mavlink", now() + kStep, kStep, [this] { step(); });
  if (scans_)
    scans_->start(executive, [this](std::shared_ptr<const core::LidarScan> scan) {
      const TimeNs stamp = scan->stamp;
      hold(stamp, [this, scan = std::move(scan)] { sink_->on_lidar(scan); });
    });
}

bool MavlinkVehicle::due(TimeNs& last, double rate_hz) const {
  const TimeNs period = core::from_seconds(1 / rate_hz);
  if (now() - last < period) return false;
  // Keeps to the rate although steps come at whole periods only.
  last = now() - last < 2 * period ? last + period : now();
  return true;
}

void MavlinkVehicle::step() {
  const TimeNs measured = executive_->measured_now();
  if (std::exchange(lost_time_, executive_->lost_time()) != executive_->lost_time()) {
    // The executive's clock was set back: what has come and waits is of the old one.
    clock_ = {};
    connection_.receive();
    while (connection_.next()) continue;
    arrived_.clear();
    held_ = {};
    sink_->on_gap();
  }
  connection_.receive();
  while (const std::optional<Frame> frame = connection_.next()) {
    if (frame->is<Timesync>()) answer(frame->as<Timesync>(), measured);
    arrived_.push_back({measured, *frame});
  }
  // A loop that is late catches up: each frame is taken in the step in which it came.
  for (; !arrived_.empty() && arrived_.front().first <= now(); arrived_.pop_front())
    take(arrived_.front().second);
  report_steering();
  keep_in_touch();
  held_.release(telemetry_.imu_stamp(), now());
}

void MavlinkVehicle::take(const Frame& frame) {
  hand_over_.on_any_message(now());
  if (frame.is<Heartbeat>()) hand_over_.on_heartbeat(frame.as<Heartbeat>(), now());
  if (frame.is<Statustext>()) hand_over_.on_text(frame.as<Statustext>(), now());
  if (frame.is<CommandAck>()) take_ack(frame.as<CommandAck>());
  if (frame.is<ParamValue>()) parameters_.on_value(frame.as<ParamValue>());
  if (frame.is<ExtendedSysState>()) report_steering();  // who steers comes before what happened
  telemetry_.take(frame, clock_, now(), *sink_);
  hand_over_.on_ground(telemetry_.standing());
}

/// Another system may command the same autopilot; 0 counts as any.
void MavlinkVehicle::take_ack(const CommandAck& m) {
  const Address own = connection_.own();
  if ((m.target_system == 0 || m.target_system == own.system) &&
      (m.target_component == 0 || m.target_component == own.component))
    commands_.on_ack(m);
}

/// The autopilot asks, too: by this it finds when a pose was true that it gets from us.
void MavlinkVehicle::answer(const Timesync& m, TimeNs measured) {
  if (m.tc1 == 0)
    connection_.send(Timesync{measured, m.ts1, connection_.peer().system, connection_.peer().component});
  else
    clock_.note_answer(m.ts1, m.tc1, measured);
}

void MavlinkVehicle::report_steering() {
  HandOver::Steering steering = hand_over_.steering(now());
  if (!hand_over_.heard() && !address_.empty()) steering.reason += " at " + address_;
  if (steering.who == reported_.who && steering.reason == reported_.reason) return;
  reported_ = std::move(steering);
  sink_->on_authority(now(), reported_.who, reported_.reason);
}

void MavlinkVehicle::keep_in_touch() {
  if (due(heartbeat_at_, kHeartbeat_hz)) {
    constexpr std::uint8_t kOnboardController = 18, kNoAutopilot = 8;
    connection_.send(Heartbeat{0, kOnboardController, kNoAutopilot, 0, kActive, 3});
  }
  if (due(timesync_at_, kTimesync_hz))
    connection_.send(
        Timesync{0, executive_->measured_now(), connection_.peer().system, connection_.peer().component});
  if (!hand_over_.connected(now())) return commands_.clear();
  ask_for_telemetry();
  ask_for_setpoint_mode();
  if (const auto command = commands_.due(now())) connection_.send(*command);
  if (const auto request = parameters_.due(now())) connection_.send(addressed(*request));
}

void MavlinkVehicle::add_command(Cmd number, std::array<float, 7> p, CommandQueue::Done done) {
  CommandLong m;
  m.command = static_cast<std::uint16_t>(number);
  m.param1 = p[0], m.param2 = p[1], m.param3 = p[2], m.param4 = p[3];
  m.param5 = p[4], m.param6 = p[5], m.param7 = p[6];
  commands_.add(addressed(m), std::move(done));
}

/// Again and again as long as the IMU does not come at half the rate, as the autopilot may have started anew,
/// or as it has not said whether it stands.
void MavlinkVehicle::ask_for_telemetry() {
  const TimeNs since = now() - telemetry_at_;
  if (!due(telemetry_at_, kTelemetryAgain_hz)) return;
  const auto samples = static_cast<double>(telemetry_.imu_samples() - imu_before_);
  imu_before_ = telemetry_.imu_samples();
  if (samples > 0.5 * options_.imu_rate_hz * core::seconds(since) && telemetry_.landed_known()) return;
  if (commands_.waits_for(Cmd::set_message_interval)) return;
  const auto ask = [this](std::uint32_t id, double rate_hz) {
    add_command(Cmd::set_message_interval,
                {static_cast<float>(id), static_cast<float>(1e6 / rate_hz), 0, 0, 0, 0, 0});
  };
  if (options_.firmware == Firmware::px4) {
    ask(HighresImu::kId, options_.imu_rate_hz);
  } else {
    ask(RawImu::kId, options_.imu_rate_hz);
    ask(ScaledPressure::kId, 20);
  }
  ask(Heartbeat::kId, 5);
  ask(ExtendedSysState::kId, 10);
  ask(BatteryStatus::kId, 2);
  ask(SysStatus::kId, 1);
  ask(LocalPositionNed::kId, 10);
  ask(AttitudeQuaternion::kId, 10);
}

void MavlinkVehicle::ask_for_setpoint_mode() {
  const bool streaming = setpoint_at_ && now() - *setpoint_at_ < kStreamBroken && streams_since_ &&
                         now() - *streams_since_ >= kStreamFirst;
  // ArduPilot takes off by a command, and gets no targets before.
  const bool ready = streaming || options_.firmware == Firmware::ardupilot;
  if (commands_.waits_for(Cmd::do_set_mode) || !hand_over_.asks(now(), ready && state_known_)) return;
  const std::uint32_t mode = setpoint_mode(options_.firmware);
  const std::uint32_t number = options_.firmware == Firmware::px4 ? mode >> 16 & 0xff : mode;
  add_command(Cmd::do_set_mode, {kCustomMode, static_cast<float>(number), 0, 0, 0, 0, 0},
              [this](CmdResult result) {
                if (result != CmdResult::accepted) hand_over_.on_refused(text_of(result));
              });
}

void MavlinkVehicle::command(const core::Command& c) {
  if (executive_ == nullptr) return;
  // What a loop that catches up commands was meant for earlier.
  if (executive_->measured_now() - now() > kTooLate) return;
  const double since_s = core::seconds(c.state.stamp - state_.stamp);
  if (state_known_ && (state_.position + since_s * state_.velocity_mps - c.state.position).norm() > kJump_m)
    ++pose_resets_;
  state_ = c.state;
  state_known_ = c.state_is_known;
  commanded_ = true;
  if (c.state_is_known && c.state.stamp > 0 && due(vision_at_, options_.vision_rate_hz))
    connection_.send(vision(c.state, pose_resets_));
  if (hand_over_.steering(now()).who == Authority::core) {
    landed_ = flown_ && !c.rates.armed;
    if (landed_) return disarm_on_ground();
    flown_ = flown_ || c.rates.armed;
    lift_off(c);
  } else {
    flown_ = landed_ = false;
  }
  const bool waits_for_take_off = options_.firmware == Firmware::ardupilot &&
                                  options_.control == Control::position && !telemetry_.airborne();
  if (waits_for_take_off || !due(target_at_, options_.setpoint_rate_hz)) return;
  if (!setpoint_at_ || now() - *setpoint_at_ > kStreamBroken) streams_since_ = now();
  setpoint_at_ = now();
  if (options_.control == Control::rates) {
    const double weight_n = description_.mass_kg * kGravity_mps2;
    connection_.send(addressed(rates_target(c.rates, options_.hover_thrust / weight_n, now())));
  } else {
    const double ahead_s = core::seconds(clock_.round_trip()) / 2;
    connection_.send(addressed(position_target(c.reference, ahead_s, now())));
  }
}

/// ArduPilot follows positions in the air only, and takes off by a command.
void MavlinkVehicle::lift_off(const core::Command& c) {
  constexpr double kAbove_m = 0.1;  // the command, or what the autopilot made of it, may have been lost
  if (options_.firmware != Firmware::ardupilot || options_.control != Control::position || !c.rates.armed ||
      !c.state_is_known || !telemetry_.standing() ||
      c.reference.position.z() < c.state.position.z() + kAbove_m || commands_.waits_for(Cmd::nav_takeoff) ||
      !due(take_off_at_, kTakeOffAgain_hz))
    return;
  add_command(Cmd::nav_takeoff, {0, 0, 0, 0, 0, 0, static_cast<float>(climb_m_)});
}

/// The core has landed. Sent at once and without waiting for an answer: the flight ends here.
void MavlinkVehicle::disarm_on_ground() {
  if (!telemetry_.standing() || !hand_over_.armed() || !due(disarm_at_, kDisarmAgain_hz)) return;
  CommandLong m;
  m.command = static_cast<std::uint16_t>(Cmd::component_arm_disarm);
  connection_.send(addressed(m));
}

std::vector<core::VehicleCheck> MavlinkVehicle::checks() const {
  std::vector<core::VehicleCheck> all = parameters_.checks();
  const auto add = [&all](std::string name, std::string required, std::string found, bool holds) {
    all.push_back({std::move(name), std::move(required), std::move(found), holds});
  };
  const bool connected = executive_ != nullptr && hand_over_.connected(now());
  add("heartbeat", "comes", connected ? "comes" : "", connected);
  const double round_trip_ms = 1e3 * core::seconds(clock_.round_trip());
  const double most_ms = options_.control == Control::rates ? kMaxRatesRoundTrip_ms : kMaxRoundTrip_ms;
  add("round trip", "at most " + text("%.0f ms", most_ms),
      clock_.known() ? text("%.1f ms", round_trip_ms) : "", clock_.known() && round_trip_ms <= most_ms);
  const auto received = static_cast<double>(connection_.loss().received());
  const auto lost = static_cast<double>(connection_.loss().lost());
  const double lost_percent = received > 0 ? 100 * lost / (received + lost) : 0;
  constexpr double kMaxLoss_percent = 5;
  add("messages lost", "at most 5 %", received > 0 ? text("%.1f %%", lost_percent) : "",
      received > 0 && lost_percent <= kMaxLoss_percent);
  for (core::VehicleCheck& check : health_checks(telemetry_.system())) all.push_back(std::move(check));
  // The core's state comes with its commands: a preflight, which gives none, has nothing to compare with.
  if (!commanded_) return all;
  // Frames or an origin that differ are flown into the rock.
  const auto& position = telemetry_.position();
  const double off_m = position && state_known_ ? (*position - state_.position).norm() : 0;
  constexpr double kMaxOff_m = 0.3, kMaxOff_deg = 10;
  add("autopilot's position", "that of the core within 0.3 m",
      position && state_known_ ? text("%.2f m apart", off_m) : "",
      position && state_known_ && off_m <= kMaxOff_m);
  const auto& attitude = telemetry_.orientation();
  const double off_deg =
      attitude && state_known_ ? attitude->angularDistance(state_.orientation) * 180 / std::numbers::pi : 0;
  add("autopilot's attitude", "that of the core within 10 deg",
      attitude && state_known_ ? text("%.1f deg apart", off_deg) : "",
      attitude && state_known_ && off_deg <= kMaxOff_deg);
  return all;
}

void MavlinkVehicle::finish() {
  constexpr int kMayBeLost = 3;
  for (int i = 0; i < kMayBeLost && landed_; ++i) {
    disarm_at_ = kNever;
    disarm_on_ground();
  }
  if (!run_dir_.empty() && executive_ != nullptr)
    write_link_record(run_dir_ + "/mavlink.json", connection_, clock_, now() - started_);
}

}  // namespace karst::mavlink
