// The point and IMU packets of Livox's SDK2 protocol, as the Mid-360 sends them. Source: "Livox LiDAR
// Communication Protocol - Mid360", v1.4.11 (2024-02-22).
//
// A header of 36 bytes: version u8 = 0; length u16, of the whole packet; time_interval u16, from the first to
// the last point in 0.1 us; dot_num u16; udp_cnt u16; frame_cnt u8; data_type u8; time_type u8; 12 bytes
// reserved; crc32 u32 over all that follows; timestamp u64, ns, of the first point. Then the points: x, y, z
// (3 x i32, mm) in type 1, (3 x i16, cm) in type 2, or depth (u32, mm), zenith angle and azimuth (u16, 0.01
// deg) in type 3; each with its reflectivity and tag (2 x u8). Type 0 is the IMU: angular velocity (3 floats,
// rad/s), acceleration (3 floats, g). All numbers are little-endian.
#pragma once
#include <optional>

#include "core_stack/vehicle/messages.h"
#include "plugins/lidar_drivers/packet/little_endian_bytes.h"

namespace karst::lidar {

enum class LivoxData : std::uint8_t { imu = 0, cartesian_mm = 1, cartesian_cm = 2, spherical = 3 };

struct LivoxHeader {
  std::uint16_t time_interval = 0;  // 0.1 us
  std::uint16_t points = 0;
  std::uint16_t count = 0;  // udp_cnt
  LivoxData data = LivoxData::cartesian_mm;
  std::uint64_t timestamp_ns = 0;

  /// Time of point i, ns after the first.
  std::int64_t point_ns(std::size_t i) const {
    return points < 2 ? 0 : static_cast<std::int64_t>(i) * time_interval * 100 / (points - 1);
  }
};

struct LivoxPoint {
  core::Vec3f position = core::Vec3f::Zero();  // m; zero: no return
  std::uint8_t reflectivity = 0;
  std::uint8_t tag = 0;
};

/// What is in a packet. A packet is foreign if it does not look like one of Livox: its version, length or
/// type is another. It is damaged if the check sum does not hold or the values cannot be.
enum class LivoxVerdict { good, foreign, damaged };
LivoxVerdict read_livox_header(PacketView packet, LivoxHeader& header);
/// Point i of a good packet.
LivoxPoint livox_point(PacketView packet, const LivoxHeader& header, std::size_t i);
/// The sample of a good packet of type imu, in the IMU's axes; its stamp is by the sensor's clock. None if
/// its values cannot be.
std::optional<core::ImuSample> livox_imu(PacketView packet, const LivoxHeader& header);

/// A packet of points. The positions are rounded as the type has it.
Packet livox_packet(const LivoxHeader& header, const std::vector<LivoxPoint>& points);
Packet livox_imu_packet(const core::ImuSample& sample, std::uint16_t count);

}  // namespace karst::lidar
