#include "plugins/replay/recording_info.h"
#include "tests/fuzz/as_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return karst::fuzz::read_as_file(data, size, ".info", [](const std::string& path) {
    karst::replay::layout_of(karst::replay::read_recording_info(path), path);
  });
}
