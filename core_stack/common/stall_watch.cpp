#include "core_stack/common/stall_watch.h"

namespace karst::core {

StallWatch::StallWatch(const Executive& executive, std::chrono::milliseconds patience, Report report)
    : executive_(executive), patience_(patience), report_(std::move(report)), thread_([this] { watch(); }) {}

StallWatch::~StallWatch() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void StallWatch::watch() {
  std::unique_lock lock(mutex_);
  // In slices: a process that was stopped for a while (Ctrl-Z, a debugger) has not used up its patience.
  constexpr int kSlices = 10;
  int still = 0;
  for (std::uint64_t before = executive_.events(); still < kSlices;) {
    if (wake_.wait_for(lock, patience_ / kSlices, [this] { return over_; })) return;
    const std::uint64_t now = executive_.events();
    still = now == before ? still + 1 : 0;
    before = now;
  }
  report_(executive_.running());
}

}  // namespace karst::core
