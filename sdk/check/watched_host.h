// A wrapper around the host as seen by a policy: counts calls, records refusals, and can make calls fail or
// take time.
#pragma once
#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "sdk/abi/karst_abi.h"

namespace karst::check {

class WatchedHost {
 public:
  /// The available services; the others are NULL.
  struct Offer {
    bool path = true, gain = true, draw = true;
  };
  explicit WatchedHost(const karst_host_t& inner) : WatchedHost(inner, Offer()) {}
  WatchedHost(const karst_host_t& inner, Offer offer);
  WatchedHost(const WatchedHost&) = delete;
  WatchedHost& operator=(const WatchedHost&) = delete;

  const karst_host_t* host() const { return &host_; }

  /// Called before a service that can fail, with its name, on any thread. If it returns a code other than
  /// KARST_OK, the policy gets that code. Set it only while the policy is idle.
  std::function<std::int32_t(const char* service)> before;
  bool stopping = false;  // returned by should_stop

  std::uint64_t calls() const { return calls_; }
  /// After its destruction the policy must not call the host any more.
  void close() { closed_ = true; }
  std::uint64_t late_calls() const { return late_calls_; }
  /// Refusals by the host itself, such as "map.cast_rays: a ray is not finite", each once.
  std::vector<std::string> refusals() const;

 private:
  friend struct Wrapped;
  const karst_host_t& inner_;
  karst_map_service_t map_{};
  karst_path_service_t path_{};
  karst_gain_service_t gain_{};
  karst_draw_service_t draw_{};
  karst_host_t host_{};
  std::atomic<std::uint64_t> calls_ = 0, late_calls_ = 0;
  std::atomic<bool> closed_ = false;
  mutable std::mutex mutex_;
  std::vector<std::string> refusals_;
};

}  // namespace karst::check
