// A sensor of the full pose, like motion capture or a good LiDAR odometry: noise, delay, slow drift.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "core_stack/vehicle/messages.h"

namespace karst::sim {

/// Which vehicles carry it; a vehicle with a LiDAR localizes itself.
enum class PoseSensorFitted { without_lidar, always, never };
constexpr auto names_of(PoseSensorFitted) {
  using enum PoseSensorFitted;
  return std::to_array<core::Named<PoseSensorFitted>>(
      {{without_lidar, "without_lidar"}, {always, "always"}, {never, "never"}});
}

struct PoseSensorOptions {
  PoseSensorFitted fitted = PoseSensorFitted::without_lidar;
  double rate_hz = 50;
  double delay_s = 0.05;
  double noise_m = 0.01;  // standard deviation of each component
  double noise_rad = 0.2 * 0.017453292519943295;
  double drift_percent = 0.02;                             // of the path length, after 100 m
  double heading_drift_rad = 0.05 * 0.017453292519943295;  // after 100 m
};
void describe(core::OptionTable& t, PoseSensorOptions& o);

/// Drift is a random walk along the path: its standard deviation grows with the square root of the distance
/// and is what the options say after 100 m.
class PoseSensor {
 public:
  PoseSensor(const PoseSensorOptions& o, const core::Pose& T_world_start, core::Random random);
  core::PoseSample sample(core::TimeNs stamp, const core::Pose& T_world_body);

 private:
  PoseSensorOptions options_;
  core::Random random_;
  core::Vec3 last_position_, drift_ = core::Vec3::Zero();
  double heading_drift_ = 0;
};

}  // namespace karst::sim
