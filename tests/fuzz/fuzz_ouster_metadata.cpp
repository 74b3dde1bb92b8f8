// Any JSON as the metadata of an Ouster sensor: it is refused, or its model and packets can be made.
#include <cstdlib>

#include "plugins/lidar_drivers/ouster/packet_layout.h"
#include "tests/fuzz/as_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return karst::fuzz::read_as_file(data, size, ".json", [](const std::string& path) {
    const auto m = karst::lidar::read_ouster_metadata(path);
    const auto model = karst::lidar::lidar_model(m, {});
    const karst::lidar::OusterLayout layout(m);
    if (model.columns < 1 || model.period <= 0 || m.columns_in_window() < 1 || layout.packet_bytes() == 0)
      std::abort();
    if (karst::lidar::ouster_metadata_of(json_text_of(m), "again").altitude_deg != m.altitude_deg)
      std::abort();
  });
}
