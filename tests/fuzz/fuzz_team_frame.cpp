// Any bytes from the radio: they are refused, or what was read can be written and read again. A frame's tag
// is put right first, or the fuzzer would never get past it: so it speaks as one who holds the mission's key.
#include <cstdlib>

#include "core_stack/homing/path_home/homing_tree.h"
#include "core_stack/team/communication/gossip.h"
#include "tests/unit/team/communication/test_radio.h"

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
  const MissionKey key = testing::test_key();
  if (bytes.size() > kTagBytes) {
    bytes.resize(bytes.size() - kTagBytes);
    const Tag tag = tag_of(bytes, key);
    bytes.insert(bytes.end(), tag.begin(), tag.end());
  }
  const auto frame = read_frame(bytes, key, why);
  if (frame && write_frame(*frame, key) != bytes) std::abort();
  Gossip robot(testing::radio(1), {}, 1);
  robot.receive(bytes, frame ? frame->sent : kSecond);
  robot.send((frame ? frame->sent : kSecond) + kSecond);
  return 0;
}
