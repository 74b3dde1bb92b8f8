// Ouster's IMU packets: 48 bytes, of the profile LEGACY of IMU data. Timestamps (u64, ns) of the system, the
// accelerometer and the gyroscope; acceleration (3 floats, g) and angular velocity (3 floats, deg/s).
#pragma once
#include <optional>

#include "core_stack/vehicle/messages.h"
#include "plugins/lidar_drivers/packet/little_endian_bytes.h"

namespace karst::lidar {

constexpr std::size_t kOusterImuBytes = 48;

/// A sample in the IMU's own axes. Its stamp is the gyroscope's, by the sensor's clock. None if the packet is
/// not one, or if its values cannot be.
std::optional<core::ImuSample> read_ouster_imu(PacketView packet);
Packet ouster_imu_packet(const core::ImuSample& sample);

}  // namespace karst::lidar
