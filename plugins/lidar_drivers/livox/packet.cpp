#include "plugins/lidar_drivers/livox/packet.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "plugins/lidar_drivers/packet/plausible.h"

namespace karst::lidar {
namespace {

constexpr std::size_t kPointsAt = 36, kChecked = 28, kImuData = 24;
constexpr double kRadiansOfStep = std::numbers::pi / 18000;
constexpr std::uint8_t kLastType = 3;
constexpr std::uint16_t kMaxZenith = 18000, kMaxAzimuth = 36000;

std::size_t bytes_of_point(LivoxData data) {
  switch (data) {
    case LivoxData::imu:
      return kImuData;
    case LivoxData::cartesian_mm:
      return 14;
    case LivoxData::cartesian_cm:
      return 8;
    case LivoxData::spherical:
      return 10;
  }
  return 0;
}

std::uint32_t check_sum(PacketView packet) {
  const PacketView checked = packet.subspan(kChecked);
  return static_cast<std::uint32_t>(crc32(0, checked.data(), static_cast<uInt>(checked.size())));
}

Packet blank_packet(const LivoxHeader& h, std::size_t points) {
  Packet packet(kPointsAt + points * bytes_of_point(h.data));
  store(packet, 1, static_cast<std::uint16_t>(packet.size()));
  store(packet, 3, h.time_interval);
  store(packet, 5, static_cast<std::uint16_t>(points));
  store(packet, 7, h.count);
  store(packet, 10, static_cast<std::uint8_t>(h.data));
  store(packet, 28, h.timestamp_ns);
  return packet;
}

void put_point(Packet& packet, std::size_t at, LivoxData data, const LivoxPoint& p) {
  const auto put_cartesian = [&]<class Number>(Number, double per_m) {
    for (Eigen::Index axis = 0; axis < 3; ++axis, at += sizeof(Number)) {
      constexpr auto kMost = static_cast<double>(std::numeric_limits<Number>::max());
      store(packet, at,
            static_cast<Number>(
                std::clamp(std::round(per_m * static_cast<double>(p.position[axis])), -kMost, kMost)));
    }
  };
  if (data == LivoxData::cartesian_mm) put_cartesian(std::int32_t{}, 1000);
  if (data == LivoxData::cartesian_cm) put_cartesian(std::int16_t{}, 100);
  if (data == LivoxData::spherical) {
    const core::Vec3 v = p.position.cast<double>();
    const double depth_m = v.norm();
    const double zenith = depth_m > 0 ? std::acos(std::clamp(v.z() / depth_m, -1.0, 1.0)) : 0;
    const double azimuth = std::atan2(v.y(), v.x());
    store(packet, at, static_cast<std::uint32_t>(std::lround(1000 * depth_m)));
    store(packet, at + 4, static_cast<std::uint16_t>(std::lround(zenith / kRadiansOfStep)));
    store(packet, at + 6,
          static_cast<std::uint16_t>(
              std::lround((azimuth < 0 ? azimuth + 2 * std::numbers::pi : azimuth) / kRadiansOfStep)));
    at += 8;
  }
  store(packet, at, p.reflectivity);
  store(packet, at + 1, p.tag);
}

template <class Number>
core::Vec3f position_at(PacketView packet, std::size_t at, float metres) {
  const auto axis = [&](std::size_t i) {
    return metres * static_cast<float>(load<Number>(packet, at + i * sizeof(Number)));
  };
  return {axis(0), axis(1), axis(2)};
}

}  // namespace

LivoxVerdict read_livox_header(PacketView packet, LivoxHeader& h) {
  if (packet.size() < kPointsAt || packet[0] != 0 || load<std::uint16_t>(packet, 1) != packet.size() ||
      packet[10] > kLastType)
    return LivoxVerdict::foreign;
  h.time_interval = load<std::uint16_t>(packet, 3);
  h.points = load<std::uint16_t>(packet, 5);
  h.count = load<std::uint16_t>(packet, 7);
  h.data = static_cast<LivoxData>(packet[10]);
  h.timestamp_ns = load<std::uint64_t>(packet, kChecked);
  // An IMU packet has one sample, whatever dot_num says.
  const std::size_t points = h.data == LivoxData::imu ? 1 : h.points;
  const auto sum = load<std::uint32_t>(packet, 24);
  const bool good = packet.size() == kPointsAt + points * bytes_of_point(h.data) && points > 0 &&
                    h.timestamp_ns < kEndOfTime_ns && sum == check_sum(packet);
  return good ? LivoxVerdict::good : LivoxVerdict::damaged;
}

LivoxPoint livox_point(PacketView packet, const LivoxHeader& h, std::size_t i) {
  const std::size_t bytes = bytes_of_point(h.data), at = kPointsAt + i * bytes;
  LivoxPoint p;
  p.reflectivity = packet[at + bytes - 2];
  p.tag = packet[at + bytes - 1];
  if (h.data == LivoxData::cartesian_mm) p.position = position_at<std::int32_t>(packet, at, 0.001f);
  if (h.data == LivoxData::cartesian_cm) p.position = position_at<std::int16_t>(packet, at, 0.01f);
  if (h.data == LivoxData::spherical) {
    const auto zenith = load<std::uint16_t>(packet, at + 4), azimuth = load<std::uint16_t>(packet, at + 6);
    if (zenith > kMaxZenith || azimuth > kMaxAzimuth) return p;
    const double depth_m = load<std::uint32_t>(packet, at) / 1000.0;
    const double t = kRadiansOfStep * zenith, a = kRadiansOfStep * azimuth;
    p.position = (depth_m * core::Vec3(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t)))
                     .cast<float>();
  }
  return p;
}

std::optional<core::ImuSample> livox_imu(PacketView packet, const LivoxHeader& h) {
  if (h.data != LivoxData::imu) return std::nullopt;
  core::ImuSample s;
  s.stamp = static_cast<core::TimeNs>(h.timestamp_ns);
  s.body_rate_radps = position_at<float>(packet, kPointsAt, 1).cast<double>();
  s.specific_force_mps2 =
      kStandardGravity_mps2 * position_at<float>(packet, kPointsAt + 12, 1).cast<double>();
  return is_plausible(s) ? std::optional(s) : std::nullopt;
}

Packet livox_packet(const LivoxHeader& h, const std::vector<LivoxPoint>& points) {
  Packet packet = blank_packet(h, points.size());
  const std::size_t bytes = bytes_of_point(h.data);
  for (std::size_t i = 0; i < points.size(); ++i) put_point(packet, kPointsAt + i * bytes, h.data, points[i]);
  store(packet, 24, check_sum(packet));
  return packet;
}

Packet livox_imu_packet(const core::ImuSample& s, std::uint16_t count) {
  LivoxHeader h;
  h.data = LivoxData::imu;
  h.count = count;
  h.timestamp_ns = static_cast<std::uint64_t>(s.stamp);
  Packet packet = blank_packet(h, 1);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    store(packet, kPointsAt + 4 * i, static_cast<float>(s.body_rate_radps[axis]));
    store(packet, kPointsAt + 12 + 4 * i,
          static_cast<float>(s.specific_force_mps2[axis] / kStandardGravity_mps2));
  }
  store(packet, 24, check_sum(packet));
  return packet;
}

}  // namespace karst::lidar
