#include "plugins/replay/rings.h"

#include <algorithm>
#include <cmath>

namespace karst::replay {

void rings_by_elevation(Scan& scan, const RecordingInfo& info) {
  const double last = static_cast<double>(info.rings - 1);
  const double spacing_rad = last > 0 ? (info.highest_rad - info.lowest_rad) / last : 0.1;
  std::erase_if(scan.points, [&](ScanPoint& p) {
    const double elevation = std::atan2(p.position.z(), p.position.head<2>().norm());
    const double ring = (info.highest_rad - elevation) / spacing_rad;
    if (ring < -1 || ring > last + 1) return true;
    p.ring = static_cast<std::uint16_t>(std::clamp(std::round(ring), 0.0, last));
    return false;
  });
  scan.has_ring = true;
}

void rings_by_order(Scan& scan) {
  std::uint16_t ring = 0;
  bool opposite = false;
  double first = 0, last = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const auto& p = scan.points[i].position;
    const double azimuth = std::atan2(p.y(), p.x());
    if (i == 0) first = azimuth;
    const double turned = core::wrap_angle(azimuth - first);
    if (opposite && std::abs(turned) < 1.5 && last * turned <= 0 && std::abs(last) < 1.5) {
      ring = static_cast<std::uint16_t>(ring + (ring < 65535));
      opposite = false;
    }
    opposite = opposite || std::abs(turned) > 2.0;
    last = turned;
    scan.points[i].ring = ring;
  }
  scan.has_ring = true;
}

}  // namespace karst::replay
