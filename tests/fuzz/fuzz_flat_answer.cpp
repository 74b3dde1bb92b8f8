// What a policy's own process may write: each message is refused with a FlatError, or what was read can be
// written and comes out again as it is. The first byte says which message.
#include <cstdlib>

#include "sdk/host/serialization/flat_answer.h"

using namespace karst::host;

namespace {

template <class Read>
void read_and_write(std::span<const std::byte> bytes, Read read) {
  try {
    const auto once = flatten(read(bytes));
    if (flatten(read(once)) != once) std::abort();
  } catch (const FlatError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto bytes = std::as_bytes(std::span(data + 1, size - 1));
  switch (data[0] % 7) {
    case 0:
      read_and_write(bytes, read_ready_report);
      break;
    case 1:
      read_and_write(bytes, read_decision_report);
      break;
    case 2:
      read_and_write(bytes, read_lengths_question);
      break;
    case 3:
      read_and_write(bytes, read_event);
      break;
    case 4:
      read_and_write(bytes, read_path_answer);
      break;
    case 5:
      read_and_write(bytes, read_paths_answer);
      break;
    default:
      read_and_write(bytes, read_text);
  }
  return 0;
}
