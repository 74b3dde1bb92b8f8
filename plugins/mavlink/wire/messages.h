// The messages that karst exchanges with an autopilot, of the dialect "common". Names and units are those of
// https://mavlink.io/en/messages/common.html; the number after each table is the checksum byte given there.
#pragma once
#include "plugins/mavlink/wire/fields.h"

namespace karst::mavlink {

/// Who is there, its mode and state; once a second.
struct Heartbeat {
  static constexpr std::uint32_t kId = 0;
  static constexpr std::string_view kName = "HEARTBEAT";
  std::uint32_t custom_mode = 0;
  std::uint8_t type = 0, autopilot = 0, base_mode = 0, system_status = 0;
  std::uint8_t mavlink_version = 3;
  static constexpr auto fields() {
    return std::tuple(field("custom_mode", &Heartbeat::custom_mode), field("type", &Heartbeat::type),
                      field("autopilot", &Heartbeat::autopilot), field("base_mode", &Heartbeat::base_mode),
                      field("system_status", &Heartbeat::system_status),
                      field("mavlink_version", &Heartbeat::mavlink_version));
  }
};
static_assert(crc_extra<Heartbeat>() == 50);

/// State of sensors and power.
struct SysStatus {
  static constexpr std::uint32_t kId = 1;
  static constexpr std::string_view kName = "SYS_STATUS";
  std::uint32_t onboard_control_sensors_present = 0, onboard_control_sensors_enabled = 0;
  std::uint32_t onboard_control_sensors_health = 0;
  std::uint16_t load = 0, voltage_battery = 0;
  std::int16_t current_battery = 0;
  std::uint16_t drop_rate_comm = 0, errors_comm = 0, errors_count1 = 0, errors_count2 = 0;
  std::uint16_t errors_count3 = 0, errors_count4 = 0;
  std::int8_t battery_remaining = 0;
  std::uint32_t onboard_control_sensors_present_extended = 0, onboard_control_sensors_enabled_extended = 0;
  std::uint32_t onboard_control_sensors_health_extended = 0;
  static constexpr auto fields() {
    return std::tuple(
        field("onboard_control_sensors_present", &SysStatus::onboard_control_sensors_present),
        field("onboard_control_sensors_enabled", &SysStatus::onboard_control_sensors_enabled),
        field("onboard_control_sensors_health", &SysStatus::onboard_control_sensors_health),
        field("load", &SysStatus::load), field("voltage_battery", &SysStatus::voltage_battery),
        field("current_battery", &SysStatus::current_battery),
        field("drop_rate_comm", &SysStatus::drop_rate_comm), field("errors_comm", &SysStatus::errors_comm),
        field("errors_count1", &SysStatus::errors_count1), field("errors_count2", &SysStatus::errors_count2),
        field("errors_count3", &SysStatus::errors_count3), field("errors_count4", &SysStatus::errors_count4),
        field("battery_remaining", &SysStatus::battery_remaining),
        extension("onboard_control_sensors_present_extended",
                  &SysStatus::onboard_control_sensors_present_extended),
        extension("onboard_control_sensors_enabled_extended",
                  &SysStatus::onboard_control_sensors_enabled_extended),
        extension("onboard_control_sensors_health_extended",
                  &SysStatus::onboard_control_sensors_health_extended));
  }
};
static_assert(crc_extra<SysStatus>() == 124);

/// Asks for a parameter, by its name if the index is -1.
struct ParamRequestRead {
  static constexpr std::uint32_t kId = 20;
  static constexpr std::string_view kName = "PARAM_REQUEST_READ";
  std::int16_t param_index = -1;
  std::uint8_t target_system = 0, target_component = 0;
  std::array<char, 16> param_id{};
  static constexpr auto fields() {
    return std::tuple(field("param_index", &ParamRequestRead::param_index),
                      field("target_system", &ParamRequestRead::target_system),
                      field("target_component", &ParamRequestRead::target_component),
                      field("param_id", &ParamRequestRead::param_id));
  }
};
static_assert(crc_extra<ParamRequestRead>() == 214);

/// A parameter; PX4 puts the bits of an integer into the float, ArduPilot its value.
struct ParamValue {
  static constexpr std::uint32_t kId = 22;
  static constexpr std::string_view kName = "PARAM_VALUE";
  float param_value = 0;
  std::uint16_t param_count = 0, param_index = 0;
  std::array<char, 16> param_id{};
  std::uint8_t param_type = 0;
  static constexpr auto fields() {
    return std::tuple(field("param_value", &ParamValue::param_value),
                      field("param_count", &ParamValue::param_count),
                      field("param_index", &ParamValue::param_index),
                      field("param_id", &ParamValue::param_id), field("param_type", &ParamValue::param_type));
  }
};
static_assert(crc_extra<ParamValue>() == 220);

/// Of ArduPilot: mG, mrad/s and mgauss, FRD.
struct RawImu {
  static constexpr std::uint32_t kId = 27;
  static constexpr std::string_view kName = "RAW_IMU";
  std::uint64_t time_usec = 0;
  std::int16_t xacc = 0, yacc = 0, zacc = 0, xgyro = 0, ygyro = 0, zgyro = 0, xmag = 0;
  std::int16_t ymag = 0, zmag = 0;
  std::uint8_t id = 0;
  std::int16_t temperature = 0;
  static constexpr auto fields() {
    return std::tuple(field("time_usec", &RawImu::time_usec), field("xacc", &RawImu::xacc),
                      field("yacc", &RawImu::yacc), field("zacc", &RawImu::zacc),
                      field("xgyro", &RawImu::xgyro), field("ygyro", &RawImu::ygyro),
                      field("zgyro", &RawImu::zgyro), field("xmag", &RawImu::xmag),
                      field("ymag", &RawImu::ymag), field("zmag", &RawImu::zmag),
                      extension("id", &RawImu::id), extension("temperature", &RawImu::temperature));
  }
};
static_assert(crc_extra<RawImu>() == 144);

/// Air pressure, hPa.
struct ScaledPressure {
  static constexpr std::uint32_t kId = 29;
  static constexpr std::string_view kName = "SCALED_PRESSURE";
  std::uint32_t time_boot_ms = 0;
  float press_abs = 0, press_diff = 0;
  std::int16_t temperature = 0, temperature_press_diff = 0;
  static constexpr auto fields() {
    return std::tuple(
        field("time_boot_ms", &ScaledPressure::time_boot_ms), field("press_abs", &ScaledPressure::press_abs),
        field("press_diff", &ScaledPressure::press_diff), field("temperature", &ScaledPressure::temperature),
        extension("temperature_press_diff", &ScaledPressure::temperature_press_diff));
  }
};
static_assert(crc_extra<ScaledPressure>() == 115);

/// FRD to NED; rates in rad/s.
struct AttitudeQuaternion {
  static constexpr std::uint32_t kId = 31;
  static constexpr std::string_view kName = "ATTITUDE_QUATERNION";
  std::uint32_t time_boot_ms = 0;
  float q1 = 0, q2 = 0, q3 = 0, q4 = 0, rollspeed = 0, pitchspeed = 0, yawspeed = 0;
  std::array<float, 4> repr_offset_q{};
  static constexpr auto fields() {
    return std::tuple(field("time_boot_ms", &AttitudeQuaternion::time_boot_ms),
                      field("q1", &AttitudeQuaternion::q1), field("q2", &AttitudeQuaternion::q2),
                      field("q3", &AttitudeQuaternion::q3), field("q4", &AttitudeQuaternion::q4),
                      field("rollspeed", &AttitudeQuaternion::rollspeed),
                      field("pitchspeed", &AttitudeQuaternion::pitchspeed),
                      field("yawspeed", &AttitudeQuaternion::yawspeed),
                      extension("repr_offset_q", &AttitudeQuaternion::repr_offset_q));
  }
};
static_assert(crc_extra<AttitudeQuaternion>() == 246);

/// The autopilot's own estimate, m and m/s.
struct LocalPositionNed {
  static constexpr std::uint32_t kId = 32;
  static constexpr std::string_view kName = "LOCAL_POSITION_NED";
  std::uint32_t time_boot_ms = 0;
  float x = 0, y = 0, z = 0, vx = 0, vy = 0, vz = 0;
  static constexpr auto fields() {
    return std::tuple(field("time_boot_ms", &LocalPositionNed::time_boot_ms),
                      field("x", &LocalPositionNed::x), field("y", &LocalPositionNed::y),
                      field("z", &LocalPositionNed::z), field("vx", &LocalPositionNed::vx),
                      field("vy", &LocalPositionNed::vy), field("vz", &LocalPositionNed::vz));
  }
};
static_assert(crc_extra<LocalPositionNed>() == 185);

/// A command with seven parameters.
struct CommandLong {
  static constexpr std::uint32_t kId = 76;
  static constexpr std::string_view kName = "COMMAND_LONG";
  float param1 = 0, param2 = 0, param3 = 0, param4 = 0, param5 = 0, param6 = 0, param7 = 0;
  std::uint16_t command = 0;
  std::uint8_t target_system = 0, target_component = 0, confirmation = 0;
  static constexpr auto fields() {
    return std::tuple(field("param1", &CommandLong::param1), field("param2", &CommandLong::param2),
                      field("param3", &CommandLong::param3), field("param4", &CommandLong::param4),
                      field("param5", &CommandLong::param5), field("param6", &CommandLong::param6),
                      field("param7", &CommandLong::param7), field("command", &CommandLong::command),
                      field("target_system", &CommandLong::target_system),
                      field("target_component", &CommandLong::target_component),
                      field("confirmation", &CommandLong::confirmation));
  }
};
static_assert(crc_extra<CommandLong>() == 152);

/// The answer to a command.
struct CommandAck {
  static constexpr std::uint32_t kId = 77;
  static constexpr std::string_view kName = "COMMAND_ACK";
  std::uint16_t command = 0;
  std::uint8_t result = 0, progress = 0;
  std::int32_t result_param2 = 0;
  std::uint8_t target_system = 0, target_component = 0;
  static constexpr auto fields() {
    return std::tuple(field("command", &CommandAck::command), field("result", &CommandAck::result),
                      extension("progress", &CommandAck::progress),
                      extension("result_param2", &CommandAck::result_param2),
                      extension("target_system", &CommandAck::target_system),
                      extension("target_component", &CommandAck::target_component));
  }
};
static_assert(crc_extra<CommandAck>() == 143);

/// Attitude or body rates (FRD) and thrust 0..1.
struct SetAttitudeTarget {
  static constexpr std::uint32_t kId = 82;
  static constexpr std::string_view kName = "SET_ATTITUDE_TARGET";
  std::uint32_t time_boot_ms = 0;
  std::array<float, 4> q{};
  float body_roll_rate = 0, body_pitch_rate = 0, body_yaw_rate = 0, thrust = 0;
  std::uint8_t target_system = 0, target_component = 0, type_mask = 0;
  std::array<float, 3> thrust_body{};
  static constexpr auto fields() {
    return std::tuple(field("time_boot_ms", &SetAttitudeTarget::time_boot_ms),
                      field("q", &SetAttitudeTarget::q),
                      field("body_roll_rate", &SetAttitudeTarget::body_roll_rate),
                      field("body_pitch_rate", &SetAttitudeTarget::body_pitch_rate),
                      field("body_yaw_rate", &SetAttitudeTarget::body_yaw_rate),
                      field("thrust", &SetAttitudeTarget::thrust),
                      field("target_system", &SetAttitudeTarget::target_system),
                      field("target_component", &SetAttitudeTarget::target_component),
                      field("type_mask", &SetAttitudeTarget::type_mask),
                      extension("thrust_body", &SetAttitudeTarget::thrust_body));
  }
};
static_assert(crc_extra<SetAttitudeTarget>() == 49);

/// Position, velocity, acceleration, yaw and its rate.
struct SetPositionTargetLocalNed {
  static constexpr std::uint32_t kId = 84;
  static constexpr std::string_view kName = "SET_POSITION_TARGET_LOCAL_NED";
  std::uint32_t time_boot_ms = 0;
  float x = 0, y = 0, z = 0, vx = 0, vy = 0, vz = 0, afx = 0, afy = 0, afz = 0, yaw = 0;
  float yaw_rate = 0;
  std::uint16_t type_mask = 0;
  std::uint8_t target_system = 0, target_component = 0, coordinate_frame = 0;
  static constexpr auto fields() {
    return std::tuple(
        field("time_boot_ms", &SetPositionTargetLocalNed::time_boot_ms),
        field("x", &SetPositionTargetLocalNed::x), field("y", &SetPositionTargetLocalNed::y),
        field("z", &SetPositionTargetLocalNed::z), field("vx", &SetPositionTargetLocalNed::vx),
        field("vy", &SetPositionTargetLocalNed::vy), field("vz", &SetPositionTargetLocalNed::vz),
        field("afx", &SetPositionTargetLocalNed::afx), field("afy", &SetPositionTargetLocalNed::afy),
        field("afz", &SetPositionTargetLocalNed::afz), field("yaw", &SetPositionTargetLocalNed::yaw),
        field("yaw_rate", &SetPositionTargetLocalNed::yaw_rate),
        field("type_mask", &SetPositionTargetLocalNed::type_mask),
        field("target_system", &SetPositionTargetLocalNed::target_system),
        field("target_component", &SetPositionTargetLocalNed::target_component),
        field("coordinate_frame", &SetPositionTargetLocalNed::coordinate_frame));
  }
};
static_assert(crc_extra<SetPositionTargetLocalNed>() == 143);

/// Of PX4: m/s^2, rad/s, gauss, hPa, FRD.
struct HighresImu {
  static constexpr std::uint32_t kId = 105;
  static constexpr std::string_view kName = "HIGHRES_IMU";
  std::uint64_t time_usec = 0;
  float xacc = 0, yacc = 0, zacc = 0, xgyro = 0, ygyro = 0, zgyro = 0, xmag = 0, ymag = 0;
  float zmag = 0, abs_pressure = 0, diff_pressure = 0, pressure_alt = 0, temperature = 0;
  std::uint16_t fields_updated = 0;
  std::uint8_t id = 0;
  static constexpr auto fields() {
    return std::tuple(
        field("time_usec", &HighresImu::time_usec), field("xacc", &HighresImu::xacc),
        field("yacc", &HighresImu::yacc), field("zacc", &HighresImu::zacc),
        field("xgyro", &HighresImu::xgyro), field("ygyro", &HighresImu::ygyro),
        field("zgyro", &HighresImu::zgyro), field("xmag", &HighresImu::xmag),
        field("ymag", &HighresImu::ymag), field("zmag", &HighresImu::zmag),
        field("abs_pressure", &HighresImu::abs_pressure), field("diff_pressure", &HighresImu::diff_pressure),
        field("pressure_alt", &HighresImu::pressure_alt), field("temperature", &HighresImu::temperature),
        field("fields_updated", &HighresImu::fields_updated), extension("id", &HighresImu::id));
  }
};
static_assert(crc_extra<HighresImu>() == 93);

/// tc1 = 0: a question sent at ts1; otherwise the answer, given at tc1. ns.
struct Timesync {
  static constexpr std::uint32_t kId = 111;
  static constexpr std::string_view kName = "TIMESYNC";
  std::int64_t tc1 = 0, ts1 = 0;
  std::uint8_t target_system = 0, target_component = 0;
  static constexpr auto fields() {
    return std::tuple(field("tc1", &Timesync::tc1), field("ts1", &Timesync::ts1),
                      extension("target_system", &Timesync::target_system),
                      extension("target_component", &Timesync::target_component));
  }
};
static_assert(crc_extra<Timesync>() == 34);

/// mV, cA, mAh, hJ, percent, s.
struct BatteryStatus {
  static constexpr std::uint32_t kId = 147;
  static constexpr std::string_view kName = "BATTERY_STATUS";
  std::int32_t current_consumed = 0, energy_consumed = 0;
  std::int16_t temperature = 0;
  std::array<std::uint16_t, 10> voltages{};
  std::int16_t current_battery = 0;
  std::uint8_t id = 0, battery_function = 0, type = 0;
  std::int8_t battery_remaining = 0;
  std::int32_t time_remaining = 0;
  std::uint8_t charge_state = 0;
  std::array<std::uint16_t, 4> voltages_ext{};
  std::uint8_t mode = 0;
  std::uint32_t fault_bitmask = 0;
  static constexpr auto fields() {
    return std::tuple(
        field("current_consumed", &BatteryStatus::current_consumed),
        field("energy_consumed", &BatteryStatus::energy_consumed),
        field("temperature", &BatteryStatus::temperature), field("voltages", &BatteryStatus::voltages),
        field("current_battery", &BatteryStatus::current_battery), field("id", &BatteryStatus::id),
        field("battery_function", &BatteryStatus::battery_function), field("type", &BatteryStatus::type),
        field("battery_remaining", &BatteryStatus::battery_remaining),
        extension("time_remaining", &BatteryStatus::time_remaining),
        extension("charge_state", &BatteryStatus::charge_state),
        extension("voltages_ext", &BatteryStatus::voltages_ext), extension("mode", &BatteryStatus::mode),
        extension("fault_bitmask", &BatteryStatus::fault_bitmask));
  }
};
static_assert(crc_extra<BatteryStatus>() == 154);

/// Whether it stands on the ground.
struct ExtendedSysState {
  static constexpr std::uint32_t kId = 245;
  static constexpr std::string_view kName = "EXTENDED_SYS_STATE";
  std::uint8_t vtol_state = 0, landed_state = 0;
  static constexpr auto fields() {
    return std::tuple(field("vtol_state", &ExtendedSysState::vtol_state),
                      field("landed_state", &ExtendedSysState::landed_state));
  }
};
static_assert(crc_extra<ExtendedSysState>() == 130);

/// A sentence for people.
struct Statustext {
  static constexpr std::uint32_t kId = 253;
  static constexpr std::string_view kName = "STATUSTEXT";
  std::uint8_t severity = 0;
  std::array<char, 50> text{};
  std::uint16_t id = 0;
  std::uint8_t chunk_seq = 0;
  static constexpr auto fields() {
    return std::tuple(field("severity", &Statustext::severity), field("text", &Statustext::text),
                      extension("id", &Statustext::id), extension("chunk_seq", &Statustext::chunk_seq));
  }
};
static_assert(crc_extra<Statustext>() == 83);

/// A pose and velocity by other means than the autopilot's.
struct Odometry {
  static constexpr std::uint32_t kId = 331;
  static constexpr std::string_view kName = "ODOMETRY";
  std::uint64_t time_usec = 0;
  float x = 0, y = 0, z = 0;
  std::array<float, 4> q{};
  float vx = 0, vy = 0, vz = 0, rollspeed = 0, pitchspeed = 0, yawspeed = 0;
  std::array<float, 21> pose_covariance{}, velocity_covariance{};
  std::uint8_t frame_id = 0, child_frame_id = 0, reset_counter = 0, estimator_type = 0;
  std::int8_t quality = 0;
  static constexpr auto fields() {
    return std::tuple(
        field("time_usec", &Odometry::time_usec), field("x", &Odometry::x), field("y", &Odometry::y),
        field("z", &Odometry::z), field("q", &Odometry::q), field("vx", &Odometry::vx),
        field("vy", &Odometry::vy), field("vz", &Odometry::vz), field("rollspeed", &Odometry::rollspeed),
        field("pitchspeed", &Odometry::pitchspeed), field("yawspeed", &Odometry::yawspeed),
        field("pose_covariance", &Odometry::pose_covariance),
        field("velocity_covariance", &Odometry::velocity_covariance), field("frame_id", &Odometry::frame_id),
        field("child_frame_id", &Odometry::child_frame_id),
        extension("reset_counter", &Odometry::reset_counter),
        extension("estimator_type", &Odometry::estimator_type), extension("quality", &Odometry::quality));
  }
};
static_assert(crc_extra<Odometry>() == 91);

using AllMessages =
    std::tuple<Heartbeat, SysStatus, ParamRequestRead, ParamValue, RawImu, ScaledPressure, AttitudeQuaternion,
               LocalPositionNed, CommandLong, CommandAck, SetAttitudeTarget, SetPositionTargetLocalNed,
               HighresImu, Timesync, BatteryStatus, ExtendedSysState, Statustext, Odometry>;

}  // namespace karst::mavlink
