// Work split into chunks of a fixed size. The thread that runs a chunk varies, the chunk's contents do not:
// results joined in the order of the chunks have the same bytes for any number of threads.
#pragma once
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace karst::core {

/// The scheduling of a thread, for those that it starts and waits for: without it a thread with a real-time
/// priority waits for threads that have none (priority inversion).
class ThreadScheduling {
 public:
  static ThreadScheduling of_this_thread() {
    ThreadScheduling s;
    s.policy_ = sched_getscheduler(0);
    sched_getparam(0, &s.param_);
    return s;
  }
  /// Usual threads stay as they are.
  void apply() const {
    const int policy = policy_ & ~SCHED_RESET_ON_FORK;
    if (policy == SCHED_FIFO || policy == SCHED_RR) sched_setscheduler(0, policy_, &param_);
  }

 private:
  int policy_ = SCHED_OTHER;
  sched_param param_{};
};

/// Calls work(chunk, first, end) for each chunk of `chunk_size` of the `count` items, on up to `threads`
/// threads; returns when all chunks are done. `work` must not throw.
template <class Work>
void for_each_chunk(std::size_t count, std::size_t chunk_size, int threads, const Work& work) {
  const std::size_t chunks = (count + chunk_size - 1) / chunk_size;
  std::atomic<std::size_t> next{0};
  const auto take_chunks = [&] {
    for (std::size_t c = next++; c < chunks; c = next++)
      work(c, c * chunk_size, std::min(count, (c + 1) * chunk_size));
  };
  const std::size_t helpers = std::min(static_cast<std::size_t>(std::max(threads, 1)), chunks);
  if (helpers <= 1) return take_chunks();
  std::vector<std::jthread> others;
  const ThreadScheduling scheduling = ThreadScheduling::of_this_thread();
  for (std::size_t i = 1; i < helpers; ++i)
    others.emplace_back([&] {
      scheduling.apply();
      take_chunks();
    });
  take_chunks();
}

inline std::size_t chunk_count(std::size_t count, std::size_t chunk_size) {
  return (count + chunk_size - 1) / chunk_size;
}

}  // namespace karst::core
