// Datagrams to and from a sensor.
#pragma once
#include <cstdint>
#include <string>
#include <utility>

#include "plugins/lidar_drivers/transport/packet_source.h"

namespace karst::lidar {

/// A socket, closed with its owner.
class Socket {
 public:
  explicit Socket(int descriptor) : descriptor_(descriptor) {}
  Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Socket& operator=(Socket&&) = delete;
  ~Socket();
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Whether `text` is an address such as 192.168.1.10.
bool is_address(const std::string& text);

/// Receives on a port of this host. The system's buffer is the queue, and bounds it: when nobody receives, it
/// drops the newest datagrams, and the sensor's counters tell how many.
class UdpReceiver final : public PacketSource {
 public:
  struct Options {
    std::uint16_t port = 0;      // 0: any free one
    std::string sender = {};     // address "192.168.1.10": datagrams of others are ignored; "": of any sender
    int buffer_bytes = 8 << 20;  // of the system; it may grant less
    int max_packets = 4096;      // at one call; the rest waits for the next
  };
  /// Throws InputError: naming the port, if it is taken; naming the sender, if that is no address.
  explicit UdpReceiver(const Options& options);

  void receive(const std::function<void(PacketView)>& take) override;
  std::uint16_t port() const { return port_; }
  /// Datagrams of other senders.
  std::uint64_t ignored() const { return ignored_; }

 private:
  Socket socket_;
  std::uint16_t port_ = 0;
  std::uint32_t sender_ = 0;  // network byte order; 0: any
  int max_packets_;
  std::uint64_t ignored_ = 0;
  Packet buffer_;
};

/// Sends to a port of a host, as a sensor does. What cannot be sent is lost.
class UdpSender {
 public:
  /// Throws InputError if `address` is none.
  UdpSender(const std::string& address, std::uint16_t port);
  void send(PacketView packet);

 private:
  Socket socket_;
};

}  // namespace karst::lidar
