#include "sdk/evaluation/record/poses.h"
#include "tests/fuzz/as_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return karst::fuzz::read_as_file(data, size, ".tum", [](const std::string& path) {
    std::vector<std::string> problems;
    karst::evaluation::read_tum(path, problems);
  });
}
