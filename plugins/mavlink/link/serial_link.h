// MAVLink by a serial line: eight bits, no parity, one stop bit, no flow control.
#pragma once
#include <chrono>
#include <optional>
#include <string>

#include "plugins/mavlink/link/byte_link.h"
#include "plugins/mavlink/link/file_descriptor.h"

namespace karst::mavlink {

class SerialLink final : public ByteLink {
 public:
  /// Throws InputError if the line cannot be opened, or has no such rate.
  SerialLink(const std::string& device, unsigned baud);

  void send(std::span<const std::uint8_t> bytes) override;
  /// Opens the line again if it was unplugged and is back.
  void receive(std::vector<std::uint8_t>& into) override;

 private:
  std::string device_;
  unsigned baud_;
  std::optional<FileDescriptor> line_;  // nothing while it is unplugged
  std::chrono::steady_clock::time_point try_at_;
};

}  // namespace karst::mavlink
