#include "plugins/lidar_drivers/livox/encoder.h"

#include <algorithm>
#include <cmath>

#include "plugins/lidar_drivers/packet/range_corrected.h"

namespace karst::lidar {

std::vector<Packet> livox_packets(const core::LidarScan& scan, const LivoxEncoding& e, std::uint16_t& count) {
  const core::TimeNs begin = scan.stamp - scan.model->period;
  const std::int64_t slots = scan.model->period / e.step_ns;
  std::vector<LivoxPoint> points(static_cast<std::size_t>(slots));
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
    const float range_m = scan.range_m[i];
    if (!std::isfinite(range_m) || range_m <= 0) continue;
    const std::int64_t slot =
        std::clamp<std::int64_t>((scan.fired(i) - begin + e.step_ns / 2) / e.step_ns, 0, slots - 1);
    LivoxPoint& p = points[static_cast<std::size_t>(slot)];
    p.position = range_m * scan.direction[i];
    const float intensity = i < scan.intensity.size() ? scan.intensity[i] : 0;
    p.reflectivity = static_cast<std::uint8_t>(
        std::lround(std::clamp(150 * intensity * intensity_fall_off(range_m), 0.0f, 150.0f)));
  }
  std::vector<Packet> packets;
  const auto most = static_cast<std::size_t>(e.points_a_packet);
  for (std::size_t first = 0; first < points.size(); first += most) {
    const std::size_t n = std::min(most, points.size() - first);
    LivoxHeader h;
    h.data = e.data;
    h.count = count++;
    h.time_interval = static_cast<std::uint16_t>(static_cast<std::int64_t>(n - 1) * e.step_ns / 100);
    h.timestamp_ns =
        static_cast<std::uint64_t>(begin + static_cast<std::int64_t>(first) * e.step_ns + e.clock_ahead_ns);
    const auto at = points.begin() + static_cast<std::ptrdiff_t>(first);
    packets.push_back(livox_packet(h, {at, at + static_cast<std::ptrdiff_t>(n)}));
  }
  return packets;
}

}  // namespace karst::lidar
