#include "plugins/lidar_drivers/lidar_driver_options.h"

#include <chrono>

#include "core_stack/common/error.h"
#include "core_stack/common/opened_by_key.h"
#include "plugins/lidar_drivers/livox_receiver.h"
#include "plugins/lidar_drivers/ouster_receiver.h"
#include "plugins/lidar_drivers/packet/mount.h"
#include "plugins/lidar_drivers/transport/udp.h"

namespace karst::lidar {
namespace {

// The ports that the units use unless they are told otherwise, by their manuals.
constexpr std::int64_t kOusterPort = 7502, kOusterImuPort = 7503, kLivoxPort = 56301, kLivoxImuPort = 56401;

std::int64_t host_clock_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

void describe(core::OptionTable& t, LidarDriverOptions& o) {
  t.add("unit", o.unit, "the LiDAR whose packets are received");
  t.add("metadata", o.metadata, {}, "file with the metadata that an Ouster sensor gives of itself, JSON");
  t.add("port", o.port, 0, 65535, "UDP port of its points; 0: 7502 (Ouster), 56301 (Livox)");
  t.add("imu_port", o.imu_port, 0, 65535, "UDP port of its IMU; 0: 7503 (Ouster), 56401 (Livox)");
  t.add("imu", o.imu, "receive the sensor's IMU as well");
  t.add("address", o.address, {}, "address of the sensor: packets of others are ignored; empty: any");
  t.add("mount", o.mount, {}, "the sensor's frame in the body's: \"x y z roll pitch yaw\" in m and degrees");
  t.add("clock", o.clock,
        "relative: the sensor's clock is its own, and its offset is estimated; ptp: it follows the host's");
  t.add(
      "clock_ahead", o.clock_ahead_s, "s", -1e6, 1e6,
      "with ptp: the sensor's clock minus the host's, such as 37 s if the sensor keeps TAI and the host UTC");
}

std::unique_ptr<ScanReceiver> open_lidar(const LidarDriverOptions& o, const std::string& source,
                                         const std::string& section) {
  if (o.unit == LidarUnit::none) return nullptr;
  const core::Pose T_body_sensor = mount_of(source, section + ".mount", o.mount);
  if (!o.address.empty() && !is_address(o.address))
    throw core::InputError(source, section + ".address",
                           "\"" + o.address + "\" is not an address such as 192.168.1.10");
  const auto open = [&](const char* key, std::int64_t given, std::int64_t usual) {
    UdpReceiver::Options udp;
    udp.port = static_cast<std::uint16_t>(given == 0 ? usual : given);
    udp.sender = o.address;
    return core::opened_by_key(source, section + "." + key,
                               [&] { return std::make_unique<UdpReceiver>(udp); });
  };
  StampSource stamps(o.clock, core::from_seconds(o.clock_ahead_s), host_clock_ns);
  if (o.unit == LidarUnit::livox_mid360)
    return std::make_unique<LivoxReceiver>(T_body_sensor, open("port", o.port, kLivoxPort),
                                           o.imu ? open("imu_port", o.imu_port, kLivoxImuPort) : nullptr,
                                           std::move(stamps));
  if (o.metadata.empty())
    throw core::InputError(source, section + ".metadata",
                           "is needed for an Ouster sensor: its beams differ from unit to unit");
  return std::make_unique<OusterReceiver>(
      core::opened_by_key(source, section + ".metadata", [&] { return read_ouster_metadata(o.metadata); }),
      T_body_sensor, open("port", o.port, kOusterPort),
      o.imu ? open("imu_port", o.imu_port, kOusterImuPort) : nullptr, std::move(stamps));
}

}  // namespace karst::lidar
