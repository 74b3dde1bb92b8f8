// Which LiDAR a vehicle carries, and where its packets come. A vehicle adds them to its own options, below a
// prefix such as `mavlink.lidar`.
#pragma once
#include <memory>
#include <string>

#include "core_stack/common/options.h"
#include "plugins/lidar_drivers/scan_receiver.h"
#include "plugins/lidar_drivers/stamp_source.h"

namespace karst::lidar {

enum class LidarUnit { none, ouster, livox_mid360 };
constexpr auto names_of(LidarUnit) {
  using enum LidarUnit;
  return std::to_array<core::Named<LidarUnit>>(
      {{none, "none"}, {ouster, "ouster"}, {livox_mid360, "livox_mid360"}});
}

struct LidarDriverOptions {
  LidarUnit unit = LidarUnit::none;
  std::string metadata;       // Ouster's JSON
  std::int64_t port = 0;      // 0: the unit's usual one
  std::int64_t imu_port = 0;  // 0: the unit's usual one
  bool imu = false;           // whether to open the port of its IMU
  std::string address;        // of the sensor; "": any
  std::string mount = "0 0 0.1 0 0 0";
  ClockKind clock = ClockKind::relative;
  double clock_ahead_s = 0;  // of the host's clock, with ptp
};
void describe(core::OptionTable& t, LidarDriverOptions& o);

/// Opens the ports. Null without a unit. Throws InputError: metadata, port, address or mount. `source` names
/// where the options come from, and `section` what their keys stand below, such as "mavlink.lidar".
std::unique_ptr<ScanReceiver> open_lidar(const LidarDriverOptions& options, const std::string& source,
                                         const std::string& section);

}  // namespace karst::lidar
