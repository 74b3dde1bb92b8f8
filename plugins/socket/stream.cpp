#include "plugins/socket/stream.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <thread>

#include "core_stack/common/error.h"

namespace karst::socket {
namespace {

constexpr int kBufferBytes = 4 << 20;  // of the kernel, each way: a few scans
constexpr std::size_t kReadBytes = 64 << 10;
constexpr Wait kBetweenAttempts{100};

std::string reason_of(int error) { return std::strerror(error); }

/// Whether `events` came within `patience`.
bool wait_for(int fd, short events, Wait patience) {
  const auto until = std::chrono::steady_clock::now() + patience;
  for (;;) {
    const auto left = std::chrono::duration_cast<Wait>(until - std::chrono::steady_clock::now() +
                                                       std::chrono::microseconds(999));
    pollfd one{fd, events, 0};
    const int n = ::poll(&one, 1, static_cast<int>(std::max<Wait::rep>(0, left.count())));
    if (n > 0) return true;
    if (n == 0 || errno != EINTR) return false;
  }
}

/// A signal, such as Ctrl-C, must not wait for a whole minute of patience: the callers wait in small pieces.
void set_up(int fd, bool tcp) {
  const int on = 1;
  if (tcp) ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  ::setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &kBufferBytes, sizeof kBufferBytes);
  ::setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &kBufferBytes, sizeof kBufferBytes);
  ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK);
}

/// A socket's address in the form of the kernel.
struct SocketName {
  sockaddr_storage storage{};
  socklen_t size = 0;
  int family = AF_UNSPEC;
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
};

SocketName name_of_path(const std::string& path) {
  SocketName name;
  sockaddr_un un{};
  un.sun_family = AF_UNIX;
  path.copy(un.sun_path, sizeof un.sun_path - 1);
  std::memcpy(&name.storage, &un, sizeof un);
  name.size = sizeof un;
  name.family = AF_UNIX;
  return name;
}

SocketName resolve(const Address& a) {
  if (a.family == Address::Family::unix_path) return name_of_path(a.path);
  addrinfo hints{}, *found = nullptr;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_family = AF_UNSPEC;
  const int error = ::getaddrinfo(a.host.c_str(), std::to_string(a.port).c_str(), &hints, &found);
  if (error != 0)
    throw core::InputError(a.text(), "", std::string("the host is not known: ") + gai_strerror(error));
  SocketName name;
  std::memcpy(&name.storage, found->ai_addr, found->ai_addrlen);
  name.size = found->ai_addrlen;
  name.family = found->ai_family;
  ::freeaddrinfo(found);
  return name;
}

/// 0, or the error.
int try_connect(int fd, const SocketName& name, Wait patience) {
  if (::connect(fd, name.get(), name.size) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  if (!wait_for(fd, POLLOUT, patience)) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof error;
  ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

}  // namespace

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

Stream::Stream(Descriptor socket, std::uint32_t max_body) : socket_(std::move(socket)), max_body_(max_body) {}

/// Seldom, as what is not sent moves: never for less than what is given free.
void Stream::drop_sent() {
  constexpr std::size_t kKept = 1 << 20;
  if (sent_ < kKept || sent_ < backlog_bytes()) return;
  unsent_.erase(0, sent_);
  sent_ = 0;
}

bool Stream::flush(Wait patience) {
  while (sent_ < unsent_.size()) {
    const ssize_t n = ::send(socket_.get(), unsent_.data() + sent_, unsent_.size() - sent_, MSG_NOSIGNAL);
    if (n > 0) {
      sent_ += static_cast<std::size_t>(n);
      drop_sent();
    } else if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      if (patience.count() == 0 || !wait_for(socket_.get(), POLLOUT, patience)) return false;
    } else if (n < 0 && errno != EINTR) {
      throw LinkError(errno == EPIPE || errno == ECONNRESET ? "the other side closed the connection"
                                                            : "cannot send: " + reason_of(errno));
    }
  }
  unsent_.clear();
  sent_ = 0;
  return true;
}

std::optional<Frame> Stream::next() {
  if (end_ - begin_ < kHeaderBytes) return std::nullopt;
  std::uint32_t size = 0;
  std::uint16_t type = 0, zero = 0;
  std::memcpy(&size, bytes_.data() + begin_, 4);
  std::memcpy(&type, bytes_.data() + begin_ + 4, 2);
  std::memcpy(&zero, bytes_.data() + begin_ + 6, 2);
  if (size > max_body_ || zero != 0)
    throw LinkError("this is no message of the protocol: type " + std::to_string(type) + " with " +
                    std::to_string(size) + " bytes");
  if (end_ - begin_ < kHeaderBytes + size) return std::nullopt;
  const Frame frame{type, {bytes_.data() + begin_ + kHeaderBytes, size}};
  begin_ += kHeaderBytes + size;
  return frame;
}

bool Stream::receive(Wait patience) {
  if (begin_ == end_) {
    begin_ = end_ = 0;
  } else if (begin_ > 0) {
    std::memmove(bytes_.data(), bytes_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (bytes_.size() < end_ + kReadBytes) bytes_.resize(std::max(2 * bytes_.size(), end_ + kReadBytes));
  for (;;) {
    const ssize_t n = ::recv(socket_.get(), bytes_.data() + end_, bytes_.size() - end_, 0);
    if (n > 0) {
      end_ += static_cast<std::size_t>(n);
      return true;
    }
    if (n == 0)
      throw LinkError(end_ > begin_ ? "the other side closed the connection within a message"
                                    : "the other side closed the connection");
    if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (patience.count() == 0 || !wait_for(socket_.get(), POLLIN, patience)) return false;
    } else if (errno != EINTR) {
      throw LinkError(errno == ECONNRESET ? "the other side closed the connection"
                                          : "cannot receive: " + reason_of(errno));
    }
  }
}

Stream connect_to(const Address& address, Wait patience, std::uint32_t max_body) {
  const auto until = std::chrono::steady_clock::now() + patience;
  const SocketName name = resolve(address);
  for (;;) {
    Descriptor fd(::socket(name.family, SOCK_STREAM | SOCK_CLOEXEC, 0));
    if (fd.get() < 0) throw core::InputError(address.text(), "", "no socket: " + reason_of(errno));
    set_up(fd.get(), name.family != AF_UNIX);
    const int error = try_connect(fd.get(), name, patience);
    if (error == 0) return {std::move(fd), max_body};
    if (std::chrono::steady_clock::now() + kBetweenAttempts > until)
      throw core::InputError(address.text(), "", "no vehicle answers there: " + reason_of(error));
    std::this_thread::sleep_for(kBetweenAttempts);
  }
}

namespace {

/// A socket file that is left over from a process that is gone is in the way of a new one.
void remove_abandoned(const Address& a) {
  struct stat what {};
  if (::lstat(a.path.c_str(), &what) != 0 || !S_ISSOCK(what.st_mode)) return;
  const Descriptor probe(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const SocketName name = name_of_path(a.path);
  if (::connect(probe.get(), name.get(), name.size) != 0 && errno == ECONNREFUSED) ::unlink(a.path.c_str());
}

}  // namespace

Listener::Listener(const Address& address) : address_(address) {
  const SocketName name = resolve(address);
  socket_ = Descriptor(::socket(name.family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int on = 1;
  if (name.family == AF_UNIX)
    remove_abandoned(address);
  else
    ::setsockopt(socket_.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (::bind(socket_.get(), name.get(), name.size) != 0 || ::listen(socket_.get(), 8) != 0) {
    const std::string why = reason_of(errno);
    address_.path.clear();  // it is another's
    throw core::InputError(address.text(), "", "cannot listen there: " + why);
  }
  if (name.family == AF_UNIX) return;
  SocketName bound;
  bound.size = sizeof bound.storage;
  ::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&bound.storage), &bound.size);
  if (bound.storage.ss_family == AF_INET)
    address_.port = ntohs(reinterpret_cast<const sockaddr_in&>(bound.storage).sin_port);
  else if (bound.storage.ss_family == AF_INET6)
    address_.port = ntohs(reinterpret_cast<const sockaddr_in6&>(bound.storage).sin6_port);
}

Listener::~Listener() {
  if (address_.family == Address::Family::unix_path) ::unlink(address_.path.c_str());
}

std::optional<Stream> Listener::accept(Wait patience) {
  if (!wait_for(socket_.get(), POLLIN, patience)) return std::nullopt;
  Descriptor fd(::accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC));
  if (fd.get() < 0) return std::nullopt;
  set_up(fd.get(), address_.family == Address::Family::tcp);
  return Stream(std::move(fd), kMaxToVehicleBytes);
}

}  // namespace karst::socket
