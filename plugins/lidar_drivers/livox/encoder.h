// Writes a frame as the packets that a Mid-360 would send of it: for tests, and for a simulated sensor.
#pragma once
#include "plugins/lidar_drivers/livox/packet.h"

namespace karst::lidar {

struct LivoxEncoding {
  LivoxData data = LivoxData::cartesian_mm;
  std::int64_t step_ns = 5000;  // between two points: 200,000 a second
  int points_a_packet = 96;
  std::int64_t clock_ahead_ns = 0;  // the sensor's clock is the scan's plus this
};

/// The packets of one scan without rings. A point is sent in the slot next to its time; slots without a
/// point, and without a return, are zero. `count` is the number of the first packet, and afterwards of the
/// next.
std::vector<Packet> livox_packets(const core::LidarScan& scan, const LivoxEncoding& encoding,
                                  std::uint16_t& count);

}  // namespace karst::lidar
