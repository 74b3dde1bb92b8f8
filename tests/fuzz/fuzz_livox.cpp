// Any packets on the ports of a Livox sensor: whatever comes out fits its model. Length and check sum are put
// right first, or the fuzzer would never get past them.
#include <zlib.h>

#include <cstdlib>

#include "plugins/lidar_drivers/livox/frame_assembler.h"
#include "tests/fuzz/packets_of.h"

using namespace karst::lidar;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto model = std::make_shared<const karst::core::LidarModel>(mid360_model({}));
  LivoxFrameAssembler assembler(model);
  karst::core::TimeNs now = 0;
  for (const PacketView view : karst::fuzz::packets_of(data, size)) {
    Packet p(view.begin(), view.end());
    now += 3 * karst::core::kMillisecond;
    assembler.take(p, now);
    if (p.size() >= 36) {
      p[0] = 0;
      store(p, 1, static_cast<std::uint16_t>(p.size()));
      store(p, 24, static_cast<std::uint32_t>(crc32(0, p.data() + 28, static_cast<uInt>(p.size() - 28))));
      assembler.take(p, now);
    }
    LivoxHeader h;
    if (read_livox_header(p, h) == LivoxVerdict::good)
      if (const auto imu = livox_imu(p, h); imu && !imu->body_rate_radps.allFinite()) std::abort();
    for (const RawFrame& f : assembler.closed(now)) {
      if (!f.scan.fits_model() || f.scan.intensity.size() != f.scan.range_m.size()) std::abort();
      for (std::size_t i = 0; i < f.scan.range_m.size(); ++i)
        if (!(f.scan.time_s[i] <= 0) || !f.scan.direction[i].allFinite() || !(f.scan.range_m[i] > 0))
          std::abort();
    }
  }
  return 0;
}
