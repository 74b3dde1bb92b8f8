#include "plugins/lidar_drivers/ouster/encoder.h"

#include <algorithm>
#include <cmath>

#include "plugins/lidar_drivers/packet/range_corrected.h"

namespace karst::lidar {
namespace {

OusterPixel pixel_of(const core::LidarScan& scan, std::size_t i, double beam_origin_mm) {
  const float range_m = scan.range_m[i];
  if (!std::isfinite(range_m) || range_m <= 0) return {};
  const float intensity = i < scan.intensity.size() ? scan.intensity[i] : 0;
  const float reflectivity = std::clamp(100 * intensity * intensity_fall_off(range_m), 0.0f, 100.0f);
  return {static_cast<std::uint32_t>(std::lround(1000 * static_cast<double>(range_m) + beam_origin_mm)),
          static_cast<std::uint8_t>(std::lround(reflectivity))};
}

}  // namespace

std::vector<Packet> ouster_packets(const core::LidarScan& scan, const OusterMetadata& metadata,
                                   std::uint16_t frame_id, std::int64_t clock_ahead_ns) {
  const OusterLayout layout(metadata);
  const auto columns = static_cast<std::size_t>(metadata.columns_per_frame);
  std::vector<Packet> packets;
  for (std::size_t first = 0; first < columns; first += static_cast<std::size_t>(layout.columns())) {
    Packet packet = layout.blank(frame_id);
    bool any = false;
    for (int c = 0; c < layout.columns(); ++c) {
      const std::size_t column = first + static_cast<std::size_t>(c);
      if (column >= columns) continue;
      const bool sent = metadata.in_window(static_cast<int>(column));
      const auto stamp = static_cast<std::uint64_t>(scan.fired(column) + clock_ahead_ns);
      layout.put_column(packet, c, {stamp, static_cast<std::uint16_t>(column), sent}, frame_id);
      if (!sent) continue;
      any = true;
      for (int p = 0; p < metadata.pixels(); ++p)
        layout.put_pixel(
            packet, c, p,
            pixel_of(scan, static_cast<std::size_t>(p) * columns + column, metadata.beam_origin_mm));
    }
    if (any) packets.push_back(std::move(packet));
  }
  return packets;
}

}  // namespace karst::lidar
