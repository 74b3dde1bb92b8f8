// Any packets on the ports of an Ouster sensor, in each profile: whatever comes out fits its model. Packets
// of the right length are given the header of a lidar packet first, or the fuzzer would hardly get past it.
#include <cstdlib>

#include "plugins/lidar_drivers/ouster/imu_packet.h"
#include "plugins/lidar_drivers/ouster/sweep_assembler.h"
#include "tests/fuzz/packets_of.h"

using namespace karst::lidar;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  OusterMetadata m;
  constexpr OusterProfile kProfiles[] = {OusterProfile::legacy, OusterProfile::single, OusterProfile::dual,
                                         OusterProfile::low_data};
  m.profile = kProfiles[data[0] % 4];
  m.columns_per_frame = 16, m.columns_per_packet = 2, m.last_column = 15;
  m.altitude_deg = {20, -20};
  m.azimuth_deg = {3, -3};
  m.beam_origin_mm = 15;
  const auto model = std::make_shared<const karst::core::LidarModel>(lidar_model(m, {}));
  const OusterLayout layout(m);
  OusterSweepAssembler assembler(m, model);
  karst::core::TimeNs now = 0;
  for (const PacketView view : karst::fuzz::packets_of(data + 1, size - 1)) {
    Packet p(view.begin(), view.end());
    if (p.size() == layout.packet_bytes() && m.profile != OusterProfile::legacy)
      store<std::uint16_t>(p, 0, 1);
    assembler.take(p, now += 7 * karst::core::kMillisecond);
    for (const RawSweep& s : assembler.closed(now)) {
      if (!s.scan.fits_model()) std::abort();
      for (const float t : s.scan.time_s)
        if (!(t <= 0 && t >= -2.001f)) std::abort();
      for (const float r : s.scan.range_m)
        if (r < 0 || r > 1100) std::abort();  // NaN is fine
    }
    if (const auto imu = read_ouster_imu(p); imu && !imu->specific_force_mps2.allFinite()) std::abort();
  }
  return 0;
}
