#include "plugins/lidar_drivers/ouster/packet_layout.h"

#include <algorithm>

namespace karst::lidar {
namespace {

constexpr std::size_t kPacketHeader = 32, kPacketFooter = 32;  // of all profiles but LEGACY
constexpr std::size_t kFrameId = 2, kInitId = 4, kSerial = 7, kMeasurementId = 8;
constexpr std::uint16_t kLidarPacket = 1;
constexpr std::uint32_t kLegacyValid = 0xffffffff, kEncoderTicks = 90112;
constexpr std::uint64_t kSerialMask = (std::uint64_t{1} << 40) - 1;
constexpr std::uint32_t kRange19 = (1u << 19) - 1, kRange20 = (1u << 20) - 1, kRange15 = (1u << 15) - 1;
constexpr std::uint32_t kLowDataStep_mm = 8;

std::size_t bytes_of_pixel(OusterProfile profile) {
  switch (profile) {
    case OusterProfile::legacy:
    case OusterProfile::single:
      return 12;
    case OusterProfile::dual:
      return 16;
    case OusterProfile::low_data:
      return 4;
  }
  return 0;
}

}  // namespace

OusterLayout::OusterLayout(const OusterMetadata& m)
    : profile_(m.profile),
      serial_(m.serial),
      columns_(m.columns_per_packet),
      ticks_per_column_(kEncoderTicks / static_cast<std::uint32_t>(m.columns_per_frame)),
      header_bytes_(legacy() ? 0 : kPacketHeader),
      column_header_bytes_(legacy() ? 16 : 12),
      pixel_bytes_(bytes_of_pixel(m.profile)),
      column_bytes_(column_header_bytes_ + static_cast<std::size_t>(m.pixels()) * pixel_bytes_ +
                    (legacy() ? 4 : 0)),
      packet_bytes_(header_bytes_ + static_cast<std::size_t>(columns_) * column_bytes_ +
                    (legacy() ? 0 : kPacketFooter)) {}

bool OusterLayout::is_ours(PacketView packet) const {
  if (packet.size() != packet_bytes_) return false;
  if (legacy()) return true;
  const std::uint64_t serial = load<std::uint64_t>(packet, kSerial) & kSerialMask;
  return load<std::uint16_t>(packet, 0) == kLidarPacket && (serial_ == 0 || serial == serial_);
}

std::uint16_t OusterLayout::frame_id(PacketView packet) const {
  return load<std::uint16_t>(packet, legacy() ? 10 : kFrameId);
}

OusterColumnHeader OusterLayout::column(PacketView packet, int column) const {
  const std::size_t at = column_at(column);
  OusterColumnHeader h;
  h.timestamp_ns = load<std::uint64_t>(packet, at);
  h.measurement_id = load<std::uint16_t>(packet, at + kMeasurementId);
  h.valid = legacy() ? load<std::uint32_t>(packet, at + column_bytes_ - 4) == kLegacyValid
                     : (load<std::uint16_t>(packet, at + 10) & 1) != 0;
  return h;
}

OusterPixel OusterLayout::pixel(PacketView packet, int column, int pixel) const {
  const std::size_t at = pixel_at(column, pixel);
  const auto word = load<std::uint32_t>(packet, at);
  const auto byte = [&](std::size_t i) { return load<std::uint8_t>(packet, at + i); };
  switch (profile_) {
    case OusterProfile::legacy:  // reflectivity has 16 bits, and from firmware 2.1 on 8 of them in use
      return {word & kRange20,
              static_cast<std::uint8_t>(std::min<std::uint16_t>(load<std::uint16_t>(packet, at + 4), 255))};
    case OusterProfile::single:
      return {word & kRange19, byte(4)};
    case OusterProfile::dual:
      return {word & kRange19, byte(3)};
    case OusterProfile::low_data:
      return {(word & kRange15) * kLowDataStep_mm, byte(2)};
  }
  return {};
}

Packet OusterLayout::blank(std::uint16_t frame_id) const {
  Packet packet(packet_bytes_);
  if (legacy()) return packet;
  store<std::uint16_t>(packet, 0, kLidarPacket);
  store<std::uint16_t>(packet, kFrameId, frame_id);
  store<std::uint32_t>(packet, kInitId, 1);
  for (std::size_t i = 0; i < 5; ++i)
    store<std::uint8_t>(packet, kSerial + i, static_cast<std::uint8_t>(serial_ >> 8 * i));
  return packet;
}

void OusterLayout::put_column(Packet& packet, int column, const OusterColumnHeader& h,
                              std::uint16_t frame_id) const {
  const std::size_t at = column_at(column);
  store(packet, at, h.timestamp_ns);
  store(packet, at + kMeasurementId, h.measurement_id);
  if (legacy()) {
    store(packet, at + 10, frame_id);
    store<std::uint32_t>(packet, at + 12, h.measurement_id * ticks_per_column_);
    store<std::uint32_t>(packet, at + column_bytes_ - 4, h.valid ? kLegacyValid : 0);
  } else {
    store<std::uint16_t>(packet, at + 10, h.valid ? 1 : 0);
  }
}

void OusterLayout::put_pixel(Packet& packet, int column, int pixel, const OusterPixel& value) const {
  const std::size_t at = pixel_at(column, pixel);
  switch (profile_) {
    case OusterProfile::legacy:
      store(packet, at, std::min(value.range_mm, kRange20));
      store<std::uint16_t>(packet, at + 4, value.reflectivity);
      return;
    case OusterProfile::single:
      store(packet, at, std::min(value.range_mm, kRange19));
      store(packet, at + 4, value.reflectivity);
      return;
    case OusterProfile::dual:
      store(packet, at, std::min(value.range_mm, kRange19));
      store(packet, at + 3, value.reflectivity);
      return;
    case OusterProfile::low_data:
      store<std::uint16_t>(packet, at,
                           static_cast<std::uint16_t>(
                               std::min((value.range_mm + kLowDataStep_mm / 2) / kLowDataStep_mm, kRange15)));
      store(packet, at + 2, value.reflectivity);
      return;
  }
}

}  // namespace karst::lidar
