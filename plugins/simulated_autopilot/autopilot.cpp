#include "plugins/simulated_autopilot/autopilot.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <sstream>

#include "core_stack/common/error.h"
#include "plugins/mavlink/parameters.h"
#include "plugins/mavlink/sensor_health.h"
#include "plugins/mavlink/setpoints.h"

namespace karst::sim {
namespace {

using core::kMillisecond;
using core::kSecond;
using core::Quat;
using core::TimeNs;
using core::Vec3;
using mavlink::Cmd;
using mavlink::CmdResult;

constexpr mavlink::Address kAutopilot{1, mavlink::kAutopilotComponent},
    kComputer{1, mavlink::kOnboardComputer};
constexpr double kCycle_s = 0.005, kLanding_mps = 0.5, kClimb_mps = 0.7;

Vec3 frd(const Vec3& flu) { return {flu.x(), -flu.y(), -flu.z()}; }
float f(double v) { return static_cast<float>(v); }

/// Parameters as docs/mavlink.md asks for them, and then as the options say.
std::map<std::string, double> parameters_of(const AutopilotFirmwareOptions& o, double hover_thrust) {
  std::map<std::string, double> p;
  if (o.firmware == mavlink::Firmware::px4)
    p = {{"COM_OF_LOSS_T", 1},
         {"COM_OBL_RC_ACT", o.offboard_loss == OffboardLoss::land ? 4 : 5},
         {"COM_RCL_EXCEPT", 4},
         {"NAV_RCL_ACT", 3},
         {"NAV_DLL_ACT", 0},
         {"COM_LOW_BAT_ACT", 2},
         {"EKF2_EV_CTRL", 15},
         {"EKF2_HGT_REF", 3},
         {"EKF2_GPS_CTRL", 0},
         {"EKF2_NOAID_TOUT", 10e6},
         {"MPC_TILTMAX_AIR", 35},
         {"MPC_XY_VEL_MAX", 5},
         {"MPC_Z_VEL_MAX_UP", 3},
         {"MPC_Z_VEL_MAX_DN", 1.5},
         {"MPC_THR_HOVER", hover_thrust}};
  else
    p = {{"VISO_TYPE", 1},       {"EK3_SRC1_POSXY", 6}, {"EK3_SRC1_POSZ", 6},
         {"EK3_SRC1_VELXY", 6},  {"EK3_SRC1_VELZ", 6},  {"ATC_ANGLE_BOOST", 0},
         {"EK3_SRC1_YAW", 6},    {"GUID_TIMEOUT", 3},   {"FS_GCS_ENABLE", 5},
         {"FS_THR_ENABLE", 3},   {"FS_EKF_ACTION", 1},  {"BATT_FS_LOW_ACT", 0},
         {"BATT_FS_CRT_ACT", 1}, {"GUID_OPTIONS", 8},   {"MOT_THST_HOVER", hover_thrust}};
  std::istringstream given(o.parameters);
  for (std::string one; given >> one;) {
    const auto equals = one.find('=');
    std::istringstream value(equals == std::string::npos ? "" : one.substr(equals + 1));
    double v = 0;
    if (!(value >> v)) throw core::InputError("simulated_autopilot.parameters", one, "expected NAME=VALUE");
    p[one.substr(0, equals)] = v;
  }
  return p;
}

constexpr std::uint32_t kAllSensors = [] {
  std::uint32_t all = mavlink::kTransmitter.bit;
  for (const mavlink::SensorBit& sensor : mavlink::kSensorBits) all |= sensor.bit;
  return all;
}();

/// Bits of SYS_STATUS.
std::uint32_t healthy_sensors(const AutopilotFirmwareOptions& o) {
  std::uint32_t healthy = kAllSensors;
  std::istringstream names(o.unhealthy);
  for (std::string name; names >> name;) {
    const auto* const sensor = std::find_if(mavlink::kSensorBits.begin(), mavlink::kSensorBits.end(),
                                            [&name](const mavlink::SensorBit& s) { return s.name == name; });
    if (sensor == mavlink::kSensorBits.end() && name != mavlink::kTransmitter.name)
      throw core::InputError("simulated_autopilot.unhealthy", name, "is no sensor that an autopilot reports");
    healthy &= ~(sensor == mavlink::kSensorBits.end() ? mavlink::kTransmitter : *sensor).bit;
  }
  return healthy;
}

/// Whether PX4 holds it as a float; the others are integers.
bool is_real(const std::string& name) { return name.starts_with("MPC_") || name == "COM_OF_LOSS_T"; }

}  // namespace

Autopilot::Autopilot(const AutopilotFirmwareOptions& o, const AutopilotBody& body,
                     std::unique_ptr<mavlink::ByteLink> link)
    : options_(o),
      body_(body),
      script_(read_pilot_script(o.pilot)),
      parameters_(parameters_of(o, body.hover_thrust)),
      healthy_sensors_(healthy_sensors(o)),
      connection_(std::move(link), kAutopilot, kComputer),
      modes_(o),
      control_(body.hover_thrust),
      pilot_(script_.cbegin()) {
  periods_ = {{mavlink::Heartbeat::kId, kSecond},
              {mavlink::Timesync::kId, kSecond / 10},
              {mavlink::SysStatus::kId, kSecond}};
}

TimeNs Autopilot::own_time(TimeNs time) const {
  return time +
         core::from_seconds(options_.clock_offset_s + 1e-6 * options_.clock_drift_ppm * core::seconds(time));
}

/// PX4 has a parameter for it, in microseconds.
bool Autopilot::position_known() const {
  constexpr double kArduPilot_s = 10;
  const bool px4 = options_.firmware == mavlink::Firmware::px4;
  return observer_.position_known(px4 ? 1e-6 * parameters_.at("EKF2_NOAID_TOUT") : kArduPilot_s);
}

ModeInputs Autopilot::inputs() const {
  return {now_, position_known(), standing_, setpoint_at_, streams_since_, battery_.fraction_left};
}

core::AttitudeRateCommand Autopilot::step(const core::ImuSample& imu) {
  const double dt_s = now_ > 0 ? core::seconds(imu.stamp - now_) : kCycle_s;
  now_ = imu.stamp;
  imu_ = imu;
  observer_.on_imu(own_time(now_), frd(imu.specific_force_mps2), frd(imu.body_rate_radps));
  connection_.receive();
  while (const auto frame = connection_.next()) take(*frame);
  play_pilot();
  modes_.step(inputs());
  const RateTarget target = control(dt_s);
  report();
  if (!modes_.armed()) return {};
  return {frd(target.rate_radps), target.thrust * body_.max_thrust_n, true};
}

void Autopilot::take(const mavlink::Frame& frame) {
  using namespace mavlink;
  if (frame.is<Timesync>()) {
    const auto m = frame.as<Timesync>();
    if (m.tc1 == 0)
      connection_.send(Timesync{own_time(now_), m.ts1, kComputer.system, kComputer.component});
    else
      clock_.note_answer(m.ts1, m.tc1, own_time(now_));
  }
  if (frame.is<Odometry>()) take_vision(frame.as<Odometry>());
  if (frame.is<CommandLong>()) take_command(frame.as<CommandLong>());
  if (frame.is<ParamRequestRead>()) answer_parameter(frame.as<ParamRequestRead>());
  if (frame.is<SetAttitudeTarget>()) {
    const auto m = frame.as<SetAttitudeTarget>();
    if ((m.type_mask & kIgnoreAttitude) == 0) return;
    note_setpoint();
    rate_target_ =
        RateTarget{core::Vec3f(m.body_roll_rate, m.body_pitch_rate, m.body_yaw_rate).cast<double>(),
                   static_cast<double>(m.thrust)};
    position_target_.reset();
  }
  if (frame.is<SetPositionTargetLocalNed>()) {
    const auto m = frame.as<SetPositionTargetLocalNed>();
    if (m.coordinate_frame != kLocalNed) return;
    note_setpoint();
    PositionTarget t;
    t.position = core::Vec3f(m.x, m.y, m.z).cast<double>();
    t.velocity_mps = core::Vec3f(m.vx, m.vy, m.vz).cast<double>();
    t.acceleration_mps2 = core::Vec3f(m.afx, m.afy, m.afz).cast<double>();
    t.yaw_rad = static_cast<double>(m.yaw);
    t.yaw_rate_radps = static_cast<double>(m.yaw_rate);
    position_target_ = t;
    rate_target_.reset();
    takes_off_ = false;
  }
}

void Autopilot::note_setpoint() {
  if (!setpoint_at_ || now_ - *setpoint_at_ > kSecond / 2) streams_since_ = now_;
  setpoint_at_ = now_;
}

/// The pose is stamped by the computer's clock; before that is known, it counts from its arrival.
void Autopilot::take_vision(const mavlink::Odometry& m) {
  if (m.frame_id != mavlink::kLocalFrd || m.child_frame_id != mavlink::kBodyFrd) return;
  if (options_.firmware == mavlink::Firmware::px4 && m.estimator_type > mavlink::kVio) return;
  const Quat attitude = Eigen::Quaternionf(m.q[0], m.q[1], m.q[2], m.q[3]).cast<double>().normalized();
  if (!attitude.coeffs().allFinite()) return;
  const TimeNs stamp = clock_.known() ? clock_.ours(static_cast<TimeNs>(m.time_usec) * 1000) : own_time(now_);
  observer_.on_vision(stamp, core::Vec3f(m.x, m.y, m.z).cast<double>(),
                      attitude * core::Vec3f(m.vx, m.vy, m.vz).cast<double>(), attitude);
}

void Autopilot::take_command(const mavlink::CommandLong& m) {
  mavlink::CommandAck ack;
  ack.command = m.command;
  ack.result = static_cast<std::uint8_t>(carry_out(m));
  ack.target_system = kComputer.system, ack.target_component = kComputer.component;
  answers_.push_back({now_ + core::from_seconds(options_.answer_delay_s), ack});
}

CmdResult Autopilot::carry_out(const mavlink::CommandLong& m) {
  switch (static_cast<Cmd>(m.command)) {
    case Cmd::do_set_mode: {
      const bool px4 = options_.firmware == mavlink::Firmware::px4;
      const auto number = static_cast<std::uint32_t>(std::clamp(m.param2, 0.0f, 255.0f));
      if ((px4 ? number << 16 : number) != mavlink::setpoint_mode(options_.firmware))
        return CmdResult::denied;
      return modes_.select(FlightMode::guided, inputs());
    }
    case Cmd::component_arm_disarm:  // the pilot alone arms
      return m.param1 == 0 ? modes_.disarm(inputs()) : CmdResult::denied;
    case Cmd::nav_takeoff:
      if (options_.firmware != mavlink::Firmware::ardupilot || !modes_.armed() ||
          modes_.mode() != FlightMode::guided || !standing_)
        return CmdResult::failed;
      takes_off_ = true;
      take_off_m_ = static_cast<double>(m.param7);
      hover_here(Vec3::Zero());
      return CmdResult::accepted;
    case Cmd::set_message_interval:
      if (!(m.param1 >= 0 && m.param1 < 1e6f && m.param2 >= 1000)) return CmdResult::denied;
      periods_[static_cast<std::uint32_t>(m.param1)] = static_cast<TimeNs>(m.param2) * 1000;
      return CmdResult::accepted;
  }
  return CmdResult::unsupported;
}

void Autopilot::answer_parameter(const mavlink::ParamRequestRead& m) {
  const std::string name(m.param_id.begin(), std::find(m.param_id.begin(), m.param_id.end(), '\0'));
  const auto found = parameters_.find(name);
  if (found == parameters_.end()) return;
  constexpr std::uint8_t kReal32 = 9, kInt32 = 6;
  mavlink::ParamValue answer;
  answer.param_id = m.param_id;
  answer.param_count = static_cast<std::uint16_t>(parameters_.size());
  const bool bits = options_.firmware == mavlink::Firmware::px4 && !is_real(name);
  answer.param_type = bits ? kInt32 : kReal32;
  answer.param_value =
      bits ? std::bit_cast<float>(static_cast<std::int32_t>(found->second)) : f(found->second);
  connection_.send(answer);
}

/// A switch that has no effect is moved again after a second.
void Autopilot::play_pilot() {
  if (pilot_tries_ && now_ >= pilot_tries_->at) {
    PilotStep& step = *pilot_tries_;
    CmdResult result = CmdResult::accepted;
    switch (step.action) {
      case PilotAction::arm:
        result = modes_.arm(inputs());
        break;
      case PilotAction::disarm:
        result = modes_.disarm(inputs());
        break;
      case PilotAction::hand_over:
        result = modes_.armed() ? modes_.select(FlightMode::guided, inputs()) : CmdResult::denied;
        break;
      case PilotAction::take_over:
        result = modes_.select(FlightMode::position, inputs());
        break;
      case PilotAction::hold:
        result = modes_.select(FlightMode::hold, inputs());
        break;
      case PilotAction::land:
        result = modes_.select(FlightMode::land, inputs());
        break;
    }
    if (result == CmdResult::accepted)
      pilot_tries_.reset();
    else
      step.at = now_ + kSecond;
  }
  if (!pilot_tries_ && pilot_ != script_.cend() && now_ >= pilot_->at) pilot_tries_ = *pilot_++;
}

/// Where it would come to rest.
void Autopilot::hover_here(Vec3 velocity_mps) {
  constexpr double kStops_s = 0.5;
  hover_ = {};
  hover_.position = observer_.motion().position + kStops_s * velocity_mps;
  hover_.yaw_rad = yaw_of(observer_.motion().attitude);
}

RateTarget Autopilot::control(double dt_s) {
  const Motion& m = observer_.motion();
  if (!modes_.armed()) {
    control_.reset();
    takes_off_ = false;
    flown_ = modes_.mode();
    return {};
  }
  // A take-off is a command of its own: no target is awaited during it.
  const bool stops = modes_.target_timed_out() && !timed_out_ && !takes_off_;
  timed_out_ = modes_.target_timed_out();
  if (flown_ != modes_.mode() || stops) {
    flown_ = modes_.mode();
    takes_off_ = false;
    hover_here(m.velocity_mps);
  }
  if (flown_ == FlightMode::guided && !timed_out_ && !takes_off_) return follow_setpoints(dt_s);
  if (standing_ && !takes_off_) {
    control_.reset();
    return {};
  }
  if (!position_known()) return control_.level(-kLanding_mps, m, dt_s);
  PositionTarget target = hover_;
  if (flown_ == FlightMode::land) {
    target.position->z() = m.position.z();
    target.velocity_mps.z() = kLanding_mps;
  } else if (takes_off_) {
    const double left_m = m.position.z() - (hover_.position->z() - take_off_m_);
    target.position->z() = m.position.z();
    target.velocity_mps.z() = -std::clamp(left_m, -kClimb_mps, kClimb_mps);
  }
  return control_.follow(target, m, dt_s);
}

RateTarget Autopilot::follow_setpoints(double dt_s) {
  const Motion& m = observer_.motion();
  if (rate_target_) return *rate_target_;
  if (!position_target_) return {};
  const PositionTarget& t = *position_target_;
  // It stays down until it is told to rise; ArduPilot takes off by a command only.
  constexpr double kRises_m = 0.05;
  const bool rises =
      options_.firmware == mavlink::Firmware::px4 && t.position->z() < m.position.z() - kRises_m;
  if (standing_ && !rises) {
    control_.reset();
    return {};
  }
  return control_.follow(t, m, dt_s);
}

bool Autopilot::due(std::uint32_t message) {
  const auto period = periods_.find(message);
  if (period == periods_.end()) return false;
  const auto [sent, first] = sent_at_.try_emplace(message, now_);
  if (!first && now_ - sent->second < period->second) return false;
  sent->second = first || now_ - sent->second > 2 * period->second ? now_ : sent->second + period->second;
  return true;
}

void Autopilot::report() {
  for (const auto& [severity, words] : modes_.take_texts()) {
    mavlink::Statustext m;
    m.severity = severity;
    std::copy_n(words.begin(), std::min(words.size(), m.text.size()), m.text.begin());
    connection_.send(m);
  }
  for (; !answers_.empty() && answers_.front().at <= now_; answers_.pop_front())
    connection_.send(answers_.front().ack);
  report_imu();
  report_motion();
  report_system();
}

void Autopilot::report_imu() {
  const Vec3 force = frd(imu_.specific_force_mps2), rate = frd(imu_.body_rate_radps),
             field = frd(magnetometer_.field_ut);
  const auto usec = static_cast<std::uint64_t>(std::max<TimeNs>(0, own_time(now_)) / 1000);
  const double hpa = 1013.25 * std::pow(1 - barometer_.height_m / 44330.77, 1 / 0.190263);
  if (due(mavlink::HighresImu::kId)) {
    mavlink::HighresImu m;
    m.time_usec = usec;
    m.xacc = f(force.x()), m.yacc = f(force.y()), m.zacc = f(force.z());
    m.xgyro = f(rate.x()), m.ygyro = f(rate.y()), m.zgyro = f(rate.z());
    m.xmag = f(0.01 * field.x()), m.ymag = f(0.01 * field.y()), m.zmag = f(0.01 * field.z());
    m.abs_pressure = f(hpa);
    m.pressure_alt = f(barometer_.height_m);
    m.fields_updated = 0x3f;
    // Each sample once: the compass and the barometer come less often.
    if (magnetometer_.stamp == now_ - 5 * kMillisecond || magnetometer_.stamp == now_)
      m.fields_updated |= 0x1c0;
    if (barometer_.stamp == now_ - 5 * kMillisecond || barometer_.stamp == now_) m.fields_updated |= 0x1a00;
    connection_.send(m);
  }
  if (due(mavlink::RawImu::kId)) {
    const auto whole = [](double v) {
      return static_cast<std::int16_t>(std::lround(std::clamp(v, -32768.0, 32767.0)));
    };
    const Vec3 mg = force / 9.80665e-3, mrad = rate * 1e3, mgauss = field * 10;
    mavlink::RawImu m;
    m.time_usec = usec;
    m.xacc = whole(mg.x()), m.yacc = whole(mg.y()), m.zacc = whole(mg.z());
    m.xgyro = whole(mrad.x()), m.ygyro = whole(mrad.y()), m.zgyro = whole(mrad.z());
    m.xmag = whole(mgauss.x()), m.ymag = whole(mgauss.y()), m.zmag = whole(mgauss.z());
    connection_.send(m);
  }
  if (due(mavlink::ScaledPressure::kId)) {
    mavlink::ScaledPressure m;
    m.time_boot_ms = mavlink::boot_ms(own_time(now_));
    m.press_abs = f(hpa);
    connection_.send(m);
  }
}

void Autopilot::report_motion() {
  const Motion& motion = observer_.motion();
  const std::uint32_t ms = mavlink::boot_ms(own_time(now_));
  if (due(mavlink::LocalPositionNed::kId) && position_known()) {
    const core::Vec3f p = motion.position.cast<float>(), v = motion.velocity_mps.cast<float>();
    connection_.send(mavlink::LocalPositionNed{ms, p.x(), p.y(), p.z(), v.x(), v.y(), v.z()});
  }
  if (due(mavlink::AttitudeQuaternion::kId)) {
    const Quat& q = motion.attitude;
    const core::Vec3f w = motion.rate_radps.cast<float>();
    connection_.send(
        mavlink::AttitudeQuaternion{ms, f(q.w()), f(q.x()), f(q.y()), f(q.z()), w.x(), w.y(), w.z(), {}});
  }
}

void Autopilot::report_system() {
  if (due(mavlink::Heartbeat::kId)) {
    constexpr std::uint8_t kQuadrotor = 2;
    const auto base =
        static_cast<std::uint8_t>(mavlink::kCustomMode | (modes_.armed() ? mavlink::kArmed : 0));
    const mavlink::Heartbeat m{
        modes_.custom_mode(),   kQuadrotor, mavlink::autopilot_number(options_.firmware), base,
        modes_.system_status(), 3};
    connection_.send(m);
    if (options_.other_system) {
      // Disarmed, in another mode: believed, it would take the vehicle from the core.
      mavlink::Heartbeat other = m;
      other.base_mode = mavlink::kCustomMode, other.custom_mode = 0;
      connection_.send_as({7, mavlink::kAutopilotComponent}, other);
      connection_.send_as({7, mavlink::kAutopilotComponent},
                          mavlink::ExtendedSysState{0, standing_ ? std::uint8_t{2} : std::uint8_t{1}});
    }
  }
  if (due(mavlink::Timesync::kId))
    connection_.send(mavlink::Timesync{0, own_time(now_), kComputer.system, kComputer.component});
  if (due(mavlink::ExtendedSysState::kId)) {
    constexpr std::uint8_t kOnGround = 1, kInAir = 2;
    connection_.send(mavlink::ExtendedSysState{0, standing_ ? kOnGround : kInAir});
  }
  const double volts = 14 + 2.8 * battery_.fraction_left;
  const auto percent = static_cast<std::int8_t>(std::ceil(100 * battery_.fraction_left));
  const auto centiamps = static_cast<std::int16_t>(std::lround(100 * battery_.power_w / volts));
  if (due(mavlink::BatteryStatus::kId)) {
    mavlink::BatteryStatus m;
    m.voltages.fill(65535);
    m.voltages[0] = static_cast<std::uint16_t>(std::lround(1000 * volts));
    m.current_battery = centiamps;
    m.current_consumed = m.energy_consumed = -1;
    m.battery_remaining = percent;
    connection_.send(m);
  }
  if (due(mavlink::SysStatus::kId)) {
    mavlink::SysStatus m;
    m.onboard_control_sensors_present = m.onboard_control_sensors_enabled = kAllSensors;
    m.onboard_control_sensors_health = healthy_sensors_;
    m.voltage_battery = static_cast<std::uint16_t>(std::lround(1000 * volts));
    m.current_battery = centiamps;
    m.battery_remaining = percent;
    connection_.send(m);
  }
}

}  // namespace karst::sim
