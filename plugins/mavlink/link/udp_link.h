// MAVLink by UDP, a datagram for each frame or for several.
#pragma once
#include <netinet/in.h>

#include <chrono>
#include <optional>
#include <string>

#include "plugins/mavlink/link/byte_link.h"
#include "plugins/mavlink/link/file_descriptor.h"
#include "plugins/mavlink/wire/frame.h"

namespace karst::mavlink {

class UdpLink final : public ByteLink {
 public:
  /// Waits at `port` for a peer: who first sends a frame of `expected`. If it has been silent for 3 s, the
  /// same computer may go on from another port. Throws InputError.
  static UdpLink wait_at(std::uint16_t port, Address expected);
  /// Throws InputError if `host` is no IPv4 address, such as 192.168.4.1.
  static UdpLink to(const std::string& host, std::uint16_t port);

  void send(std::span<const std::uint8_t> bytes) override;
  void receive(std::vector<std::uint8_t>& into) override;
  /// Its own port.
  std::uint16_t port() const;

 private:
  UdpLink(FileDescriptor socket, std::optional<Address> expected, std::optional<sockaddr_in> peer);

  using Clock = std::chrono::steady_clock;

  FileDescriptor socket_;
  std::optional<Address> expected_;  // of a peer that it waits for
  std::optional<sockaddr_in> peer_;
  Clock::time_point heard_at_;  // from the peer
};

}  // namespace karst::mavlink
