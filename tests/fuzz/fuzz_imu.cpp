#include "plugins/replay/scan_files/imu_file.h"
#include "tests/fuzz/as_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return karst::fuzz::read_as_file(data, size, ".csv", [](const std::string& path) {
    karst::replay::ImuFile file(path, "t ax ay az wx wy wz", 1'000'000'000, karst::core::Quat::Identity());
    while (file.next()) continue;
  });
}
