// Nothing that a terminal obeys comes through, and what came through stays as it is.
#include <cstdlib>

#include "core_stack/common/printable.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string out = karst::core::printable({reinterpret_cast<const char*>(data), size});
  for (const char c : out)
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7f) std::abort();
  if (out.find("\xc2\x9b") != std::string::npos || karst::core::printable(out) != out) std::abort();
  return 0;
}
