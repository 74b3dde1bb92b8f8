#include "plugins/lidar_drivers/transport/udp.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core_stack/common/error.h"

namespace karst::lidar {
namespace {

constexpr std::size_t kLargestDatagram = 65536;

std::string place_of(std::uint16_t port) { return "UDP port " + std::to_string(port); }

Socket open_socket(const std::string& place, int flags) {
  const int descriptor = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | flags, 0);
  if (descriptor < 0) throw core::InputError(place, "", std::string("no socket: ") + std::strerror(errno));
  return Socket(descriptor);
}

/// In network byte order.
std::uint32_t address_of(const std::string& text) {
  in_addr address{};
  if (inet_pton(AF_INET, text.c_str(), &address) != 1)
    throw core::InputError(text, "", "is not an address such as 192.168.1.10");
  return address.s_addr;
}

sockaddr_in end_point(std::uint32_t address, std::uint16_t port) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_port = htons(port);
  out.sin_addr.s_addr = address;
  return out;
}

}  // namespace

bool is_address(const std::string& text) {
  in_addr address{};
  return inet_pton(AF_INET, text.c_str(), &address) == 1;
}

Socket::~Socket() {
  if (descriptor_ >= 0) close(descriptor_);
}

UdpReceiver::UdpReceiver(const Options& options)
    : socket_(open_socket(place_of(options.port), SOCK_NONBLOCK)),
      sender_(options.sender.empty() ? 0 : address_of(options.sender)),
      max_packets_(options.max_packets),
      buffer_(kLargestDatagram) {
  const int bytes = options.buffer_bytes;
  setsockopt(socket_.descriptor(), SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);  // as much as it grants
  sockaddr_in here = end_point(htonl(INADDR_ANY), options.port);
  if (bind(socket_.descriptor(), reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0)
    throw core::InputError(place_of(options.port), "", std::strerror(errno));
  socklen_t size = sizeof here;
  getsockname(socket_.descriptor(), reinterpret_cast<sockaddr*>(&here), &size);
  port_ = ntohs(here.sin_port);
}

void UdpReceiver::receive(const std::function<void(PacketView)>& take) {
  for (int i = 0; i < max_packets_; ++i) {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t got = recvfrom(socket_.descriptor(), buffer_.data(), buffer_.size(), 0,
                                 reinterpret_cast<sockaddr*>(&from), &size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return;  // nothing is left; or an error that the next call may not see
    if (sender_ != 0 && from.sin_addr.s_addr != sender_)
      ++ignored_;
    else
      take({buffer_.data(), static_cast<std::size_t>(got)});
  }
}

UdpSender::UdpSender(const std::string& address, std::uint16_t port)
    : socket_(open_socket(address, SOCK_NONBLOCK)) {
  const sockaddr_in to = end_point(address_of(address), port);
  if (connect(socket_.descriptor(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
    throw core::InputError(address, place_of(port), std::strerror(errno));
}

void UdpSender::send(PacketView packet) {
  [[maybe_unused]] const ssize_t sent =
      ::send(socket_.descriptor(), packet.data(), packet.size(), MSG_NOSIGNAL);
}

}  // namespace karst::lidar
