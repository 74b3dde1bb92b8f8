// Writes a sweep as the packets that an Ouster sensor would send of it: for tests, and for a simulated
// sensor.
#pragma once
#include "plugins/lidar_drivers/ouster/packet_layout.h"

namespace karst::lidar {

/// The packets of one sweep in the order of their columns. `metadata` is that of the scan's model
/// (metadata_for). Columns outside its window are not sent. The sensor's clock is the scan's plus
/// `clock_ahead_ns`. Ranges are rounded to 1 mm, or 8 mm in the profile RNG15; no return and no measurement
/// both become 0.
std::vector<Packet> ouster_packets(const core::LidarScan& scan, const OusterMetadata& metadata,
                                   std::uint16_t frame_id, std::int64_t clock_ahead_ns = 0);

}  // namespace karst::lidar
