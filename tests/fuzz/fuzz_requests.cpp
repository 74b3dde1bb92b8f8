// Records of requests. Sums over the bytes would refuse whatever a mutation makes, so a mutated record is
// given the right ones again: the parsers behind them are what is to be tried.
#include <algorithm>
#include <cstring>
#include <span>

#include "sdk/host/serialization/flat_request.h"
#include "sdk/host/serialization/request_log.h"
#include "tests/fuzz/as_file.h"

namespace {

constexpr std::size_t kRequestHeader = 32;

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned) {
  using karst::host::RecordFrame;
  size = LLVMFuzzerMutate(data, size, most);
  const std::span<std::byte> bytes(reinterpret_cast<std::byte*>(data), size);
  for (std::size_t at = 0; size - at >= sizeof(RecordFrame);) {
    RecordFrame frame;
    std::memcpy(&frame, bytes.data() + at, sizeof frame);
    const std::size_t left = size - at - sizeof frame;
    frame.length = std::min<std::uint64_t>(frame.length, left);
    const std::span<std::byte> payload = bytes.subspan(at + sizeof frame, frame.length);
    if (frame.kind == karst::host::kRequestRecord && payload.size() >= kRequestHeader)
      karst::host::seal(payload);
    frame = karst::host::frame_of(frame.kind, payload);
    std::memcpy(bytes.data() + at, &frame, sizeof frame);
    at += sizeof frame + payload.size();
  }
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return karst::fuzz::read_as_file(data, size, ".bin", [](const std::string& path) {
    karst::host::RequestLogReader log(path);
    while (log.next() != karst::host::RequestLogReader::Kind::end) continue;
  });
}
