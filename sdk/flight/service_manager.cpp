#include "sdk/flight/service_manager.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace karst::flight {
namespace {

long long number_in_environment(const char* name) {
  const char* text = std::getenv(name);
  long long value = 0;
  if (text) std::from_chars(text, text + std::strlen(text), value);
  return value;
}

}  // namespace

ServiceManager ServiceManager::of_environment() {
  const char* socket = std::getenv("NOTIFY_SOCKET");
  const long long of_process = number_in_environment("WATCHDOG_PID");
  const bool mine = of_process == 0 || of_process == getpid();
  return {socket ? socket : "", std::chrono::microseconds(mine ? number_in_environment("WATCHDOG_USEC") : 0)};
}

void ServiceManager::notify(const std::string& state) const {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (!listens() || socket_.size() >= sizeof address.sun_path) return;
  std::memcpy(address.sun_path, socket_.data(), socket_.size());
  if (socket_.front() == '@') address.sun_path[0] = '\0';
  const int descriptor = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor < 0) return;
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_.size());
  ::sendto(descriptor, state.data(), state.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&address),
           length);
  ::close(descriptor);
}

ServiceWatchdog::ServiceWatchdog(const ServiceManager& manager, std::function<bool()> lives,
                                 std::function<void()> on_thread)
    : manager_(manager), lives_(std::move(lives)) {
  if (manager.watchdog().count() > 0)
    thread_ = std::thread([this, on_thread = std::move(on_thread)] {
      if (on_thread) on_thread();
      run();
    });
}

ServiceWatchdog::~ServiceWatchdog() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void ServiceWatchdog::run() {
  std::unique_lock lock(mutex_);
  while (!over_) {
    if (lives_()) manager_.notify("WATCHDOG=1");
    wake_.wait_for(lock, manager_.watchdog() / 2, [this] { return over_; });
  }
}

}  // namespace karst::flight
