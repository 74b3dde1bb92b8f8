#include "core_stack/common/stall_watch.h"

namespace karst::core {

StallWatch::StallWatch(std::vector<const Executive*> executives, std::chrono::milliseconds patience,
                       Report report, std::function<void()> on_thread)
    : executives_(std::move(executives)),
      patience_(patience),
      report_(std::move(report)),
      thread_([this, on_thread = std::move(on_thread)] {
        if (on_thread) on_thread();
        watch();
      }) {}

StallWatch::~StallWatch() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

std::uint64_t StallWatch::events() const {
  std::uint64_t all = 0;
  for (const Executive* e : executives_) all += e->events();
  return all;
}

std::string StallWatch::running() const {
  for (const Executive* e : executives_)
    if (std::string name = e->running(); !name.empty()) return name;
  return "";
}

void StallWatch::watch() {
  std::unique_lock lock(mutex_);
  // In slices: a process that was stopped for a while (Ctrl-Z, a debugger) has not used up its patience.
  constexpr int kSlices = 10;
  int still = 0;
  for (std::uint64_t before = events(); still < kSlices;) {
    if (wake_.wait_for(lock, patience_ / kSlices, [this] { return over_; })) return;
    const std::uint64_t now = events();
    still = now == before ? still + 1 : 0;
    before = now;
  }
  report_(running());
}

}  // namespace karst::core
