// The one thread on which a policy is called, with a limit on the time that a caller waits for it.
#pragma once
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "sdk/host/in_process/call_limits.h"

namespace karst::host {

class DecisionThread {
 public:
  DecisionThread();
  /// Joins, unless the thread hangs in a task: then it is detached and keeps the data its task holds.
  ~DecisionThread();
  DecisionThread(const DecisionThread&) = delete;
  DecisionThread& operator=(const DecisionThread&) = delete;

  /// Runs `task` on the thread; returns "" once it has returned, otherwise the limit exceeded, in words. The
  /// thread is then abandoned for good, and shared ownership must keep alive everything the task refers to,
  /// as it may still run. `task` must not throw. Processor time is that of this thread alone.
  std::string run(std::function<void()> task, const CallLimits& limits);
  bool hangs() const { return hangs_; }
  std::thread::id id() const { return thread_.get_id(); }

 private:
  struct Channel {
    std::mutex mutex;
    std::condition_variable changed;
    std::function<void()> task;  // empty when done
    bool stop = false;
  };
  static void serve(std::shared_ptr<Channel> channel);
  double cpu_s();

  std::shared_ptr<Channel> channel_;
  std::thread thread_;
  bool hangs_ = false;
};

}  // namespace karst::host
