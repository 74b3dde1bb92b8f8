// Sees that the loop of one executive, or of a team's, hangs: by the wall clock, from a thread of its own.
//
// In lockstep the clock waits for what is late, so a step or job that never returns holds everything up for
// ever; in real time one such step does. Nobody can take it back. The watch tells its name, and whoever made
// the watch ends the process: the vehicle, given no more commands, comes down by itself.
#pragma once
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core_stack/common/executive.h"

namespace karst::core {

class StallWatch {
 public:
  /// Called once on the watch's thread, with the name of what the loop is busy with.
  using Report = std::function<void(const std::string& running)>;
  /// The executives take turns, as those of a team do: all must stand still. They outlive the watch.
  /// `on_thread` is called once on the watch's thread, before it begins.
  StallWatch(std::vector<const Executive*> executives, std::chrono::milliseconds patience, Report report,
             std::function<void()> on_thread = {});
  ~StallWatch();
  StallWatch(const StallWatch&) = delete;
  StallWatch& operator=(const StallWatch&) = delete;

 private:
  void watch();
  std::uint64_t events() const;
  std::string running() const;

  std::vector<const Executive*> executives_;
  std::chrono::milliseconds patience_;
  Report report_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool over_ = false;
  std::thread thread_;
};

}  // namespace karst::core
