// Where the fields of an Ouster lidar packet lie, of the profiles LEGACY, RNG19_RFL8_SIG16_NIR16, its DUAL,
// and RNG15_RFL8_NIR8. Source of the formats: the source of Ouster SDK 0.11.
//
// LEGACY: columns only; each has a header of 16 bytes (timestamp u64, measurement id u16, frame id u16,
// encoder u32), pixels of 12 bytes, and a status u32. The others: a header of 32 bytes (packet type u16 = 1,
// frame id u16, initialization id 24 bits, serial number 40 bits, ...), columns with a header of 12 bytes
// (timestamp u64, measurement id u16, status u16), and a footer of 32 bytes. All numbers are little-endian.
#pragma once
#include <optional>

#include "plugins/lidar_drivers/ouster/metadata.h"
#include "plugins/lidar_drivers/packet/little_endian_bytes.h"

namespace karst::lidar {

/// A pixel's first return: the strongest one of the profile with two.
struct OusterPixel {
  std::uint32_t range_mm = 0;  // from the lidar's axis, see LidarModel::beam_origin_m; 0: no return
  std::uint8_t reflectivity = 0;
};

struct OusterColumnHeader {
  std::uint64_t timestamp_ns = 0;
  std::uint16_t measurement_id = 0;
  bool valid = false;
};

class OusterLayout {
 public:
  explicit OusterLayout(const OusterMetadata& metadata);

  std::size_t packet_bytes() const { return packet_bytes_; }
  int columns() const { return columns_; }

  // Of packets of exactly packet_bytes().
  /// Whether the packet says that it is a lidar packet, and of this sensor if its serial number is known.
  bool is_ours(PacketView packet) const;
  std::uint16_t frame_id(PacketView packet) const;
  OusterColumnHeader column(PacketView packet, int column) const;
  OusterPixel pixel(PacketView packet, int column, int pixel) const;

  /// A packet without a valid column.
  Packet blank(std::uint16_t frame_id) const;
  void put_column(Packet& packet, int column, const OusterColumnHeader& header, std::uint16_t frame_id) const;
  void put_pixel(Packet& packet, int column, int pixel, const OusterPixel& value) const;

 private:
  bool legacy() const { return profile_ == OusterProfile::legacy; }
  std::size_t column_at(int column) const {
    return header_bytes_ + static_cast<std::size_t>(column) * column_bytes_;
  }
  std::size_t pixel_at(int column, int pixel) const {
    return column_at(column) + column_header_bytes_ + static_cast<std::size_t>(pixel) * pixel_bytes_;
  }

  OusterProfile profile_;
  std::uint64_t serial_;
  int columns_;
  std::uint32_t ticks_per_column_;  // of the encoder
  std::size_t header_bytes_, column_header_bytes_, pixel_bytes_, column_bytes_, packet_bytes_;
};

}  // namespace karst::lidar
