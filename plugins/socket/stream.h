// A connection that carries messages, and the socket that waits for one. Times to wait are by the machine's
// clock.
#pragma once
#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "plugins/socket/address.h"
#include "plugins/socket/wire.h"

namespace karst::socket {

using Wait = std::chrono::milliseconds;

/// The connection can no longer be used; what() says why, without the address.
class LinkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An open file descriptor, closed with its owner.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  Descriptor(Descriptor&& o) noexcept : fd_(std::exchange(o.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& o) noexcept {
    std::swap(fd_, o.fd_);
    return *this;
  }
  ~Descriptor();
  int get() const { return fd_; }

 private:
  int fd_;
};

class Stream {
 public:
  /// Bodies longer than `max_body` from the other side end the connection.
  Stream(Descriptor socket, std::uint32_t max_body);

  /// Puts a message behind those not sent yet.
  template <class M>
  void queue(const M& message) {
    append_message(unsent_, message);
  }
  /// Bytes that need not be a message.
  void queue_bytes(std::string_view bytes) { unsent_ += bytes; }
  std::size_t backlog_bytes() const { return unsent_.size() - sent_; }
  /// Bytes in memory, with those that are sent: at most twice the backlog, and 1 MiB.
  std::size_t held_bytes() const { return unsent_.size(); }
  /// Sends what is queued, for as long as `patience`; returns whether all of it is sent. Throws LinkError.
  bool flush(Wait patience);

  /// The next message if it is here; its body is valid until the next call. Throws LinkError on a header that
  /// cannot be one.
  std::optional<Frame> next();
  /// Waits for more bytes; false if none came. Throws LinkError if the other side is gone.
  bool receive(Wait patience);

 private:
  void drop_sent();

  Descriptor socket_;
  std::uint32_t max_body_;
  std::string unsent_;
  std::size_t sent_ = 0;
  std::vector<char> bytes_;  // received, from `begin_` to `end_`
  std::size_t begin_ = 0, end_ = 0;
};

/// Tries again until something listens there, or `patience` is over. Throws core::InputError naming the
/// address.
Stream connect_to(const Address& address, Wait patience, std::uint32_t max_body);

class Listener {
 public:
  /// Throws core::InputError if the address cannot be had. A socket file that nobody listens at any more is
  /// replaced.
  explicit Listener(const Address& address);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// The address, with the port that was chosen if 0 was asked for.
  const Address& address() const { return address_; }
  std::optional<Stream> accept(Wait patience);

 private:
  Address address_;
  Descriptor socket_;
};

}  // namespace karst::socket
