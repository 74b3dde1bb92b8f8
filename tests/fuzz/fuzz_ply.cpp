#include "plugins/replay/scan_files/scan_file.h"
#include "tests/fuzz/as_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return karst::fuzz::read_as_file(data, size, ".ply",
                                   [](const std::string& path) { karst::replay::read_scan(path); });
}
