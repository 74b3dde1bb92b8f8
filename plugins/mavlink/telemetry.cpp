#include "plugins/mavlink/telemetry.h"

#include <algorithm>
#include <cmath>

#include "plugins/mavlink/ned.h"

namespace karst::mavlink {
namespace {

using core::Quat;
using core::TimeNs;
using core::Vec3;
using core::Vec3f;

constexpr double kMilliG_mps2 = 9.80665e-3, kGauss_ut = 100, kMilligauss_ut = 0.1;
/// HIGHRES_IMU.fields_updated: any axis of the compass, and the air's pressure.
constexpr std::uint16_t kMagUpdated = 0x1c0, kPressureUpdated = 0x200;
constexpr double kPowerSmoothing = 0.1;  // of the mean that predicts the time left: about 10 samples

}  // namespace

double height_by_pressure_m(double hpa, double first_hpa) {
  constexpr double kScale_m = 44330.77, kExponent = 0.190263;
  return kScale_m * (1 - std::pow(hpa / first_hpa, kExponent));
}

std::optional<TimeNs> Telemetry::imu_time(std::uint64_t usec, const ClockSync& clock, TimeNs now) {
  if (!clock.known() || usec > 1ull << 52) return std::nullopt;
  const TimeNs stamp = std::min(clock.ours(static_cast<TimeNs>(usec) * 1000), now);
  if (imu_stamp_ && stamp <= *imu_stamp_) return std::nullopt;
  return stamp;
}

void Telemetry::pass_imu(TimeNs stamp, const Vec3& force_frd, const Vec3& rate_frd, core::VehicleSink& sink) {
  // Beyond what such a sensor can measure; not a number is beyond it, too.
  constexpr double kMaxForce_mps2 = 400, kMaxRate_radps = 100;
  if (!(force_frd.norm() < kMaxForce_mps2) || !(rate_frd.norm() < kMaxRate_radps)) return;
  imu_stamp_ = stamp;
  ++imu_samples_;
  sink.on_imu({stamp, flu_of_frd(force_frd), flu_of_frd(rate_frd)});
}

void Telemetry::pass_pressure(TimeNs stamp, double hpa, core::VehicleSink& sink) {
  constexpr double kLowest_hpa = 100, kHighest_hpa = 1500;
  if (!(hpa > kLowest_hpa && hpa < kHighest_hpa)) return;
  if (!first_hpa_) first_hpa_ = hpa;
  sink.on_barometer({stamp, height_by_pressure_m(hpa, *first_hpa_)});
}

void Telemetry::take_highres(const HighresImu& m, const ClockSync& clock, TimeNs now,
                             core::VehicleSink& sink) {
  const auto stamp = imu_time(m.time_usec, clock, now);
  if (!stamp) return;
  pass_imu(*stamp, Vec3f(m.xacc, m.yacc, m.zacc).cast<double>(),
           Vec3f(m.xgyro, m.ygyro, m.zgyro).cast<double>(), sink);
  const Vec3f field(m.xmag, m.ymag, m.zmag);
  if ((m.fields_updated & kMagUpdated) != 0 && field.allFinite())
    sink.on_magnetometer({*stamp, flu_of_frd(kGauss_ut * field.cast<double>())});
  if ((m.fields_updated & kPressureUpdated) != 0)
    pass_pressure(*stamp, static_cast<double>(m.abs_pressure), sink);
}

void Telemetry::take_raw(const RawImu& m, const ClockSync& clock, TimeNs now, core::VehicleSink& sink) {
  const auto stamp = imu_time(m.time_usec, clock, now);
  if (!stamp) return;
  pass_imu(*stamp, kMilliG_mps2 * Vec3(m.xacc, m.yacc, m.zacc), 1e-3 * Vec3(m.xgyro, m.ygyro, m.zgyro), sink);
  if (m.xmag != 0 || m.ymag != 0 || m.zmag != 0)
    sink.on_magnetometer({*stamp, flu_of_frd(kMilligauss_ut * Vec3(m.xmag, m.ymag, m.zmag))});
}

void Telemetry::take_battery(const BatteryStatus& m, TimeNs now, core::VehicleSink& sink) {
  if (m.id != 0 || m.battery_remaining < 0) return;
  constexpr std::uint16_t kNoCell = 65535;
  double volts = 0;
  for (const std::uint16_t mv : m.voltages)
    if (mv != kNoCell) volts += 1e-3 * mv;
  core::BatteryStatus out;
  out.stamp = now;
  out.fraction_left = std::min(1.0, m.battery_remaining / 100.0);
  out.energy_left_wh = out.fraction_left * capacity_wh_;
  if (m.current_battery >= 0) out.power_w = volts * 0.01 * m.current_battery;
  // As on the ground nothing tells what flying takes, the mean begins there with the first power in the air.
  if (!standing_) mean_power_w_ += (mean_power_w_ > 0 ? kPowerSmoothing : 1) * (out.power_w - mean_power_w_);
  constexpr double kUsualFlight_s = 600;  // until the power in the air is known
  out.seconds_left =
      mean_power_w_ > 0 ? out.energy_left_wh * 3600 / mean_power_w_ : out.fraction_left * kUsualFlight_s;
  sink.on_battery(out);
}

void Telemetry::take_landed(const ExtendedSysState& m, TimeNs now, core::VehicleSink& sink) {
  constexpr std::uint8_t kUndefined = 0, kOnGround = 1;  // MAV_LANDED_STATE
  if (m.landed_state == kUndefined) return;
  const bool standing = m.landed_state == kOnGround;
  if (landed_known_ && standing == standing_) return;
  landed_known_ = true;
  standing_ = standing;
  if (standing)
    sink.on_ground(now);
  else
    sink.on_lift_off(now);
}

void Telemetry::take(const Frame& frame, const ClockSync& clock, TimeNs now, core::VehicleSink& sink) {
  switch (frame.id) {
    case HighresImu::kId:
      return take_highres(frame.as<HighresImu>(), clock, now, sink);
    case RawImu::kId:
      return take_raw(frame.as<RawImu>(), clock, now, sink);
    case ScaledPressure::kId:
      if (imu_stamp_)
        pass_pressure(*imu_stamp_, static_cast<double>(frame.as<ScaledPressure>().press_abs), sink);
      return;
    case BatteryStatus::kId:
      return take_battery(frame.as<BatteryStatus>(), now, sink);
    case SysStatus::kId:
      system_ = frame.as<SysStatus>();
      return;
    case ExtendedSysState::kId:
      return take_landed(frame.as<ExtendedSysState>(), now, sink);
    case LocalPositionNed::kId: {
      const auto m = frame.as<LocalPositionNed>();
      if (const Vec3f p(m.x, m.y, m.z); p.allFinite()) position_ = enu_of_ned(p.cast<double>());
      return;
    }
    case AttitudeQuaternion::kId: {
      const auto m = frame.as<AttitudeQuaternion>();
      const Eigen::Quaternionf q(m.q1, m.q2, m.q3, m.q4);
      constexpr float kUnit = 0.1f;
      if (std::abs(q.norm() - 1) < kUnit) orientation_ = enu_flu_of_ned_frd(q.normalized().cast<double>());
      return;
    }
    default:
      return;
  }
}

}  // namespace karst::mavlink
