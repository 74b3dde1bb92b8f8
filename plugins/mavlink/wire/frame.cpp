#include "plugins/mavlink/wire/frame.h"

namespace karst::mavlink {
namespace {

constexpr std::uint8_t kStart = 0xfd, kSigned = 0x01;
constexpr std::size_t kHeader = 10, kChecksum = 2, kSignature = 13;

std::uint16_t checksum(std::span<const std::uint8_t> after_start, std::uint8_t extra) {
  std::uint16_t crc = kCrcBegin;
  for (const std::uint8_t b : after_start) crc = crc_add(crc, b);
  return crc_add(crc, extra);
}

template <class... Message>
std::optional<std::uint8_t> find_extra(std::uint32_t id, std::type_identity<std::tuple<Message...>>) {
  std::optional<std::uint8_t> found;
  ((id == Message::kId ? void(found = crc_extra<Message>()) : void()), ...);
  return found;
}

}  // namespace

std::optional<std::uint8_t> crc_extra_of(std::uint32_t id) {
  return find_extra(id, std::type_identity<AllMessages>());
}

std::vector<std::uint8_t> to_wire(const Frame& f) {
  std::vector<std::uint8_t> out(kHeader + f.size + kChecksum);
  const std::array<std::uint8_t, kHeader> header{kStart,
                                                 f.size,
                                                 0,
                                                 0,
                                                 f.sequence,
                                                 f.from.system,
                                                 f.from.component,
                                                 static_cast<std::uint8_t>(f.id),
                                                 static_cast<std::uint8_t>(f.id >> 8),
                                                 static_cast<std::uint8_t>(f.id >> 16)};
  std::copy(header.begin(), header.end(), out.begin());
  std::copy_n(f.bytes.begin(), f.size, out.begin() + kHeader);
  const std::size_t checked = kHeader + f.size;
  const std::uint16_t crc = checksum(std::span(out).subspan(1, checked - 1), crc_extra_of(f.id).value_or(0));
  out[checked] = static_cast<std::uint8_t>(crc);
  out[checked + 1] = static_cast<std::uint8_t>(crc >> 8);
  return out;
}

FrameParser::Found FrameParser::look(std::span<const std::uint8_t> rest, Frame& frame,
                                     std::size_t& size) const {
  if (rest.size() < kHeader) return Found::incomplete;
  const std::uint8_t flags = rest[2];
  if ((flags & ~kSigned) != 0) return Found::garbage;  // made for a later MAVLink
  const std::size_t payload = rest[1], checked = kHeader + payload;
  size = checked + kChecksum + ((flags & kSigned) != 0 ? kSignature : 0);
  if (rest.size() < size) return Found::incomplete;
  frame.id = static_cast<std::uint32_t>(rest[7] | rest[8] << 8 | rest[9] << 16);
  const auto extra = crc_extra_of(frame.id);
  if (!extra) return rest.size() == size || rest[size] == kStart ? Found::unknown : Found::garbage;
  if (checksum(rest.subspan(1, checked - 1), *extra) != (rest[checked] | rest[checked + 1] << 8))
    return Found::garbage;
  frame.size = rest[1];
  frame.sequence = rest[4];
  frame.from = {rest[5], rest[6]};
  std::copy_n(rest.begin() + kHeader, payload, frame.bytes.begin());
  return Found::frame;
}

std::optional<Frame> FrameParser::next() {
  std::size_t at = 0;
  std::optional<Frame> found;
  while (!found && at < buffer_.size()) {
    const auto begin = buffer_.begin() + static_cast<std::ptrdiff_t>(at);
    const auto skipped = std::find(begin, buffer_.end(), kStart) - begin;
    at += static_cast<std::size_t>(skipped);
    counts_.garbage_bytes += static_cast<std::uint64_t>(skipped);
    if (at == buffer_.size()) break;
    Frame frame;
    std::size_t size = 0;
    const Found what = look(std::span(buffer_).subspan(at), frame, size);
    if (what == Found::incomplete) break;
    if (what == Found::garbage) {
      ++at;
      ++counts_.garbage_bytes;
      continue;
    }
    at += size;
    ++(what == Found::frame ? counts_.frames : counts_.unknown);
    if (what == Found::frame) found = frame;
  }
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(at));
  return found;
}

void LossCount::note(const Frame& f) {
  std::optional<std::uint8_t>& next = next_[f.from.component];
  // A frame that comes twice, or behind a later one, looks like a gap of almost 256.
  constexpr std::uint8_t kGreatestGap = 128;
  const auto gap = static_cast<std::uint8_t>(next ? f.sequence - *next : 0);
  ++received_;
  if (gap > kGreatestGap) return;
  lost_ += gap;
  next = static_cast<std::uint8_t>(f.sequence + 1);
}

}  // namespace karst::mavlink
