#include "tests/fuzz/as_file.h"
#include "tests/fuzz/read_bag.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return karst::fuzz::read_as_file(data, size, ".db3", karst::fuzz::read_bag);
}
