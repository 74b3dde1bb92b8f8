#include "plugins/mavlink/link/udp_link.h"

#include <arpa/inet.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "core_stack/common/error.h"

namespace karst::mavlink {
namespace {

FileDescriptor open_socket(const std::string& address) {
  FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (socket.get() < 0) throw core::InputError(address, "", std::strerror(errno));
  return socket;
}

/// A peer that has been silent for so long is gone: its program was started anew at another port.
constexpr std::chrono::seconds kGone{3};

bool is_of(const Address& peer, std::span<const std::uint8_t> datagram) {
  FrameParser parser;
  parser.add(datagram);
  while (const auto frame = parser.next())
    if (frame->from == peer) return true;
  return false;
}

const sockaddr* generic(const sockaddr_in& a) { return reinterpret_cast<const sockaddr*>(&a); }

}  // namespace

UdpLink::UdpLink(FileDescriptor socket, std::optional<Address> expected, std::optional<sockaddr_in> peer)
    : socket_(std::move(socket)), expected_(expected), peer_(peer) {}

UdpLink UdpLink::wait_at(std::uint16_t port, Address expected) {
  const std::string address = "udp:" + std::to_string(port);
  FileDescriptor socket = open_socket(address);
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_port = htons(port);
  here.sin_addr.s_addr = htonl(INADDR_ANY);
  if (::bind(socket.get(), generic(here), sizeof here) != 0)
    throw core::InputError(address, "", std::strerror(errno));
  return {std::move(socket), expected, std::nullopt};
}

UdpLink UdpLink::to(const std::string& host, std::uint16_t port) {
  const std::string address = "udp:" + host + ":" + std::to_string(port);
  sockaddr_in there{};
  there.sin_family = AF_INET;
  there.sin_port = htons(port);
  if (::inet_pton(AF_INET, host.c_str(), &there.sin_addr) != 1)
    throw core::InputError(address, "", "expected an IPv4 address such as 192.168.4.1");
  return {open_socket(address), std::nullopt, there};
}

void UdpLink::send(std::span<const std::uint8_t> bytes) {
  if (peer_) ::sendto(socket_.get(), bytes.data(), bytes.size(), 0, generic(*peer_), sizeof *peer_);
}

/// A datagram from elsewhere is dropped: another program must not steer, nor take over the link. Only the
/// computer that was the peer may go on from another port.
void UdpLink::receive(std::vector<std::uint8_t>& into) {
  std::array<std::uint8_t, 65536> datagram;
  constexpr int kMost = 256;  // in one step: a flood must not hold up the loop
  for (int i = 0; i < kMost; ++i) {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t n = ::recvfrom(socket_.get(), datagram.data(), datagram.size(), 0,
                                 reinterpret_cast<sockaddr*>(&from), &size);
    if (n < 0 && errno == ECONNREFUSED) continue;  // nobody is there yet
    if (n < 0) return;
    const auto now = Clock::now();
    const bool may_choose =
        expected_ && (!peer_ || (from.sin_addr.s_addr == peer_->sin_addr.s_addr && now - heard_at_ > kGone));
    const std::span<const std::uint8_t> bytes(datagram.data(), static_cast<std::size_t>(n));
    if (may_choose && is_of(*expected_, bytes)) peer_ = from;
    if (!peer_ || from.sin_addr.s_addr != peer_->sin_addr.s_addr || from.sin_port != peer_->sin_port)
      continue;
    heard_at_ = now;
    into.insert(into.end(), datagram.begin(), datagram.begin() + n);
  }
}

std::uint16_t UdpLink::port() const {
  sockaddr_in here{};
  socklen_t size = sizeof here;
  ::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&here), &size);
  return ntohs(here.sin_port);
}

}  // namespace karst::mavlink
