// Presets: one that is read can be written, and read as the same.
#include "sdk/selection/preset.h"
#include "tests/fuzz/as_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return karst::fuzz::read_as_file(data, size, ".info", [](const std::string& path) {
    const std::string text = to_info(karst::selection::read_preset(path), "");
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    const std::string again = karst::fuzz::as_file(bytes, text.size(), ".again.info");
    if (to_info(karst::selection::read_preset(again), "") != text) std::abort();
    unlink(again.c_str());
  });
}
