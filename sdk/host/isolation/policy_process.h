// A policy's own process, seen from the host: started, asked, watched, ended.
#pragma once
#include <sys/types.h>

#include <chrono>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <thread>

#include "sdk/host/in_process/call_limits.h"
#include "sdk/host/isolation/shared_ring.h"

namespace karst::host {

/// The process is of no more use. `what()` says why, in the same words in every replay.
struct ProcessBroken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The program that such a process runs: lib/karst/karst-policy-child beside this program's folder.
std::string policy_child_program();

/// A thread that starts a process and then waits: the process asks the kernel to end it when the thread that
/// started it ends, which is when this process ends, or this object.
class StartingThread {
 public:
  /// Throws what `start` throws.
  explicit StartingThread(const std::function<pid_t()>& start);
  ~StartingThread();
  StartingThread(const StartingThread&) = delete;
  StartingThread& operator=(const StartingThread&) = delete;

  pid_t process() const { return process_; }

 private:
  void end();

  std::promise<void> release_;
  pid_t process_ = -1;
  std::thread thread_;
};

class PolicyProcess {
 public:
  /// Starts the program with nothing but its two ends of the rings. Throws core::InputError if it cannot be.
  PolicyProcess(const std::string& program, CallLimits limits);
  /// Ends it, with a signal that cannot be caught.
  ~PolicyProcess();
  PolicyProcess(const PolicyProcess&) = delete;
  PolicyProcess& operator=(const PolicyProcess&) = delete;

  /// A call is waited for from here to `end_call`. The limits are those of a round, a decision and all that
  /// is told until the next: many short calls must not add up to a long one.
  void begin_call(const char* name);
  void end_call();
  void begin_cycle() { spent_wall_s_ = spent_cpu_s_ = 0; }
  /// Both throw ProcessBroken.
  void send(std::uint32_t kind, std::span<const std::byte> body);
  RingMessage receive(std::size_t max_bytes);
  /// Throws ProcessBroken if a limit is passed or the process is gone.
  void check() { watch(); }
  /// Waits a while for it to end by itself.
  void expect_end() noexcept;

  pid_t id() const { return id_; }

 private:
  void watch();
  double cpu_s() const;
  double waited_s() const;

  CallLimits limits_;
  RingMemory ours_, theirs_;
  std::optional<StartingThread> started_by_;
  pid_t id_ = -1;  // -1: ended, and waited for
  RingEnd ring_;
  const char* call_ = "";
  std::chrono::steady_clock::time_point call_began_;
  double cpu_before_s_ = 0;                    // the call
  double spent_wall_s_ = 0, spent_cpu_s_ = 0;  // in calls before it, of this round
};

}  // namespace karst::host
