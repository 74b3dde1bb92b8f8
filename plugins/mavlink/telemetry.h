// The autopilot's telemetry as the core's sensor messages: frames, units and clock.
#pragma once
#include <optional>

#include "core_stack/vehicle/vehicle.h"
#include "plugins/mavlink/clock_sync.h"
#include "plugins/mavlink/wire/frame.h"

namespace karst::mavlink {

class Telemetry {
 public:
  /// `capacity_wh`: of a full battery; autopilots report a fraction of it.
  explicit Telemetry(double capacity_wh) : capacity_wh_(capacity_wh) {}

  /// Passes on what the frame holds, if it is telemetry. Nothing that needs a stamp before the clock is
  /// known.
  void take(const Frame& frame, const ClockSync& clock, core::TimeNs now, core::VehicleSink& sink);

  /// Of the newest IMU sample, in our clock; nothing before the first.
  std::optional<core::TimeNs> imu_stamp() const { return imu_stamp_; }
  std::uint64_t imu_samples() const { return imu_samples_; }
  /// As the autopilot says; false before it has said anything.
  bool standing() const { return landed_known_ && standing_; }
  bool airborne() const { return landed_known_ && !standing_; }
  bool landed_known() const { return landed_known_; }
  /// The autopilot's own position and attitude, world frame.
  const std::optional<core::Vec3>& position() const { return position_; }
  const std::optional<core::Quat>& orientation() const { return orientation_; }
  /// The newest; nothing before the first.
  const std::optional<SysStatus>& system() const { return system_; }

 private:
  /// In our clock, and never in the future; nothing if it is not newer than the last sample.
  std::optional<core::TimeNs> imu_time(std::uint64_t autopilot_usec, const ClockSync& clock,
                                       core::TimeNs now);
  void pass_imu(core::TimeNs stamp, const core::Vec3& force_frd, const core::Vec3& rate_frd,
                core::VehicleSink& sink);
  void pass_pressure(core::TimeNs stamp, double hpa, core::VehicleSink& sink);
  void take_highres(const HighresImu& m, const ClockSync& clock, core::TimeNs now, core::VehicleSink& sink);
  void take_raw(const RawImu& m, const ClockSync& clock, core::TimeNs now, core::VehicleSink& sink);
  void take_battery(const BatteryStatus& m, core::TimeNs now, core::VehicleSink& sink);
  void take_landed(const ExtendedSysState& m, core::TimeNs now, core::VehicleSink& sink);

  double capacity_wh_;
  std::optional<core::TimeNs> imu_stamp_;
  std::uint64_t imu_samples_ = 0;
  std::optional<double> first_hpa_;
  double mean_power_w_ = 0;
  bool standing_ = true, landed_known_ = false;
  std::optional<core::Vec3> position_;
  std::optional<core::Quat> orientation_;
  std::optional<SysStatus> system_;
};

/// Height above where the pressure was `first_hpa`, in the troposphere of the standard atmosphere (ISO 2533).
double height_by_pressure_m(double hpa, double first_hpa);

}  // namespace karst::mavlink
