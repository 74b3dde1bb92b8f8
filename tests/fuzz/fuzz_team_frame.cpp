// Any bytes from the radio: they are refused, or what was read can be written and read again. A frame's
// checksum is put right first, or the fuzzer would never get past it.
#include <cstdlib>

#include "core_stack/homing/gossip.h"
#include "core_stack/homing/homing_tree.h"

using namespace karst::core;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, data + size);
  Refusal why{};
  if (const auto record = read_record(bytes, why)) {
    // A ray may spell out what it could have left to the one before: then it is written shorter.
    const auto again = write_record(*record);
    if (!again || again->size() > bytes.size()) std::abort();
    const auto twice = read_record(*again, why);
    if (!twice || write_record(*twice) != again) std::abort();
    if (const auto* facts = std::get_if<TreeFacts>(&*record)) {
      HomingTree tree({.max_nodes = 50}, 1.6);
      tree.apply(*facts);
      if (tree.nodes().size() > 50) std::abort();
    }
  }
  if (bytes.size() > 4) {
    bytes.resize(bytes.size() - 4);
    WireWriter(bytes).number(crc32(bytes), 4);
  }
  if (const auto frame = read_frame(bytes, why))
    if (write_frame(*frame) != bytes) std::abort();
  Gossip robot(1, {}, 1);
  robot.receive(bytes, kSecond);
  robot.send(2 * kSecond);
  return 0;
}
