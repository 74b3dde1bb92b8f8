#include "core_stack/mapping/octomap/octomap_io.h"
#include "tests/fuzz/as_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return karst::fuzz::read_as_file(data, size, ".bt",
                                   [](const std::string& path) { karst::core::read_octomap(path); });
}
