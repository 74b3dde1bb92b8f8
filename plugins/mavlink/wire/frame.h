// MAVLink 2 frames: start 0xFD, length, two bytes of flags, sequence, system, component, 24 bits of message
// id, payload, checksum; then a signature of 13 bytes if the frame is signed. Source:
// https://mavlink.io/en/guide/serialization.html
#pragma once
#include <algorithm>
#include <optional>
#include <vector>

#include "plugins/mavlink/wire/messages.h"

namespace karst::mavlink {

/// Who sends: a vehicle's number, and which of its parts.
struct Address {
  std::uint8_t system = 0, component = 0;
  bool operator==(const Address&) const = default;
};

struct Frame {
  Address from;
  std::uint8_t sequence = 0;
  std::uint32_t id = 0;
  std::uint8_t size = 0;
  std::array<std::uint8_t, 255> bytes{};

  std::span<const std::uint8_t> payload() const { return {bytes.data(), size}; }
  template <class Message>
  bool is() const {
    return id == Message::kId;
  }
  template <class Message>
  Message as() const {
    return unpack<Message>(payload());
  }
};

template <class Message>
Frame frame_of(const Message& m, Address from) {
  static_assert(payload_size<Message>() <= 255);
  Frame f;
  f.from = from;
  f.id = Message::kId;
  f.size = static_cast<std::uint8_t>(pack(m, f.bytes));
  return f;
}

/// The checksum byte of a message; nothing of one that karst does not know.
std::optional<std::uint8_t> crc_extra_of(std::uint32_t id);

/// The bytes of a frame of a known message.
std::vector<std::uint8_t> to_wire(const Frame& frame);

/// Finds frames in a stream of bytes, whatever lies between them.
///
/// A frame counts if its checksum is right. The checksum of an unknown message cannot be computed: it is
/// passed over as a whole if the next frame, or nothing yet, follows it, and otherwise taken for garbage.
/// Signatures are passed over unverified. MAVLink 1 is garbage here.
class FrameParser {
 public:
  struct Counts {
    std::uint64_t frames = 0, unknown = 0, garbage_bytes = 0;
  };

  void add(std::span<const std::uint8_t> bytes) { buffer_.insert(buffer_.end(), bytes.begin(), bytes.end()); }
  /// The next frame of a known message.
  std::optional<Frame> next();
  const Counts& counts() const { return counts_; }

 private:
  enum class Found { frame, unknown, garbage, incomplete };
  Found look(std::span<const std::uint8_t> rest, Frame& frame, std::size_t& size) const;

  std::vector<std::uint8_t> buffer_;
  Counts counts_;
};

/// Frames lost on the way, by the gaps in the sequence numbers of each sender: one a component.
class LossCount {
 public:
  void note(const Frame& frame);
  std::uint64_t received() const { return received_; }
  std::uint64_t lost() const { return lost_; }

 private:
  std::array<std::optional<std::uint8_t>, 256> next_;  // by component
  std::uint64_t received_ = 0, lost_ = 0;
};

}  // namespace karst::mavlink
