#include "plugins/lidar_drivers/ouster/imu_packet.h"

#include "plugins/lidar_drivers/packet/plausible.h"

namespace karst::lidar {
namespace {

constexpr double kRadiansOfDegree = std::numbers::pi / 180;
constexpr std::size_t kGyroStamp = 16, kAcceleration = 24, kRate = 36;

core::Vec3 vector_at(PacketView packet, std::size_t at) {
  return {static_cast<double>(load<float>(packet, at)), static_cast<double>(load<float>(packet, at + 4)),
          static_cast<double>(load<float>(packet, at + 8))};
}

}  // namespace

std::optional<core::ImuSample> read_ouster_imu(PacketView packet) {
  if (packet.size() != kOusterImuBytes) return std::nullopt;
  const auto stamp = load<std::uint64_t>(packet, kGyroStamp);
  core::ImuSample s;
  s.stamp = static_cast<core::TimeNs>(stamp);
  s.specific_force_mps2 = kStandardGravity_mps2 * vector_at(packet, kAcceleration);
  s.body_rate_radps = kRadiansOfDegree * vector_at(packet, kRate);
  return stamp < kEndOfTime_ns && is_plausible(s) ? std::optional(s) : std::nullopt;
}

Packet ouster_imu_packet(const core::ImuSample& s) {
  Packet packet(kOusterImuBytes);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    store(packet, 8 * i, static_cast<std::uint64_t>(s.stamp));
    store(packet, kAcceleration + 4 * i,
          static_cast<float>(s.specific_force_mps2[axis] / kStandardGravity_mps2));
    store(packet, kRate + 4 * i, static_cast<float>(s.body_rate_radps[axis] / kRadiansOfDegree));
  }
  return packet;
}

}  // namespace karst::lidar
