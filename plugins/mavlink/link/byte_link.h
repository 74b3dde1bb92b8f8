// A link that carries bytes to and from the autopilot: UDP, a serial line, or memory.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace karst::mavlink {

class ByteLink {
 public:
  virtual ~ByteLink() = default;
  /// Sends without waiting; what does not fit into the line's buffer is lost.
  virtual void send(std::span<const std::uint8_t> bytes) = 0;
  /// Appends what has come, without waiting.
  virtual void receive(std::vector<std::uint8_t>& into) = 0;
};

}  // namespace karst::mavlink
