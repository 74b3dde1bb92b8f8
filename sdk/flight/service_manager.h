// What a service tells systemd, by the datagrams of sd_notify(3). Without NOTIFY_SOCKET nobody is told.
#pragma once
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace karst::flight {

class ServiceManager {
 public:
  /// `socket`: a path, or @name for an abstract one; "": none. `watchdog`: within which a sign of life is
  /// due; 0: none.
  ServiceManager(std::string socket, std::chrono::microseconds watchdog)
      : socket_(std::move(socket)), watchdog_(watchdog) {}
  /// Of NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID.
  static ServiceManager of_environment();

  bool listens() const { return !socket_.empty(); }
  std::chrono::microseconds watchdog() const { return listens() ? watchdog_ : std::chrono::microseconds(0); }
  /// Never waits: what the service manager does not take is lost. `state`: such as "READY=1".
  void notify(const std::string& state) const;

 private:
  std::string socket_;
  std::chrono::microseconds watchdog_;
};

/// Signs of life, twice within the watchdog's time, as long as `lives()` says so at each.
class ServiceWatchdog {
 public:
  /// `lives` is called on the thread of the watchdog, and `on_thread` once, before.
  ServiceWatchdog(const ServiceManager& manager, std::function<bool()> lives,
                  std::function<void()> on_thread = {});
  ~ServiceWatchdog();
  ServiceWatchdog(const ServiceWatchdog&) = delete;
  ServiceWatchdog& operator=(const ServiceWatchdog&) = delete;

 private:
  void run();

  const ServiceManager& manager_;
  std::function<bool()> lives_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool over_ = false;
  std::thread thread_;  // none if no watchdog waits
};

}  // namespace karst::flight
