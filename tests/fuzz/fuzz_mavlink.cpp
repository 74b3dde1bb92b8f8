// Any bytes from the link: the parser finds what frames there are, whole or cut in two, and every frame that
// it finds is written and read again the same.
#include <cstdlib>

#include "plugins/mavlink/wire/frame.h"

using namespace karst::mavlink;

namespace {

/// Whatever the fields hold, the same comes back.
template <class... Message>
void read_and_write(const Frame& f, std::type_identity<std::tuple<Message...>>) {
  const auto one = [&f]<class M>(std::type_identity<M>) {
    if (f.id != M::kId) return;
    Frame again = frame_of(f.as<M>(), f.from);
    again.sequence = f.sequence;
    FrameParser parser;
    parser.add(to_wire(again));
    const auto back = parser.next();
    if (!back || back->size != again.size || back->bytes != again.bytes || back->from != f.from) std::abort();
  };
  (one(std::type_identity<Message>()), ...);
}

std::uint64_t frames(FrameParser& parser) {
  std::uint64_t n = 0;
  while (const auto f = parser.next()) {
    ++n;
    read_and_write(*f, std::type_identity<AllMessages>());
  }
  return n;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span<const std::uint8_t> all(data + 1, size - 1);
  FrameParser parser;
  const std::size_t half = all.empty() ? 0 : data[0] % (all.size() + 1);
  parser.add(all.first(half));
  std::uint64_t found = frames(parser);
  parser.add(all.subspan(half));
  found += frames(parser);
  const FrameParser::Counts& c = parser.counts();
  if (c.frames != found || c.garbage_bytes > all.size()) std::abort();
  return 0;
}
