// A policy's own process, seen from the host: started, asked, watched, ended.
#pragma once
#include <sys/types.h>

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "sdk/host/in_process/call_limits.h"
#include "sdk/host/isolation/output_drain.h"
#include "sdk/host/isolation/shared_ring.h"

namespace karst::host {

/// The process can no longer be used. `what()` gives the reason, in the same words in every replay.
struct ProcessBroken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Path of the program that such a process runs: lib/karst/karst-policy-child beside this program's folder.
std::string policy_child_program();

/// A thread that starts a process and then waits. The started process asks the kernel to end it with the
/// thread that started it, that is, when this process or this object ends.
class StartingThread {
 public:
  /// Passes on exceptions of `start`.
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
  /// Starts the program with its two ends of the rings, and a pipe for what it prints if somebody takes that
  /// (`output`). Throws core::InputError if it cannot be run.
  PolicyProcess(const std::string& program, CallLimits limits,
                std::shared_ptr<PolicyOutput> output = nullptr);
  /// Ends it, with a signal that cannot be caught.
  ~PolicyProcess();
  PolicyProcess(const PolicyProcess&) = delete;
  PolicyProcess& operator=(const PolicyProcess&) = delete;

  /// Begins the time of a call, which `end_call` ends. The limits apply to a decision cycle: a decision and
  /// all events until the next one, so that many short calls cannot add up to a long one.
  void begin_call(const char* name);
  void end_call();
  void begin_cycle() { spent_wall_s_ = spent_cpu_s_ = 0; }
  void set_limits(CallLimits limits) { limits_ = limits; }
  /// Both throw ProcessBroken.
  void send(std::uint32_t kind, std::span<const std::byte> body);
  RingMessage receive(std::size_t max_bytes);
  /// Throws ProcessBroken if a limit is exceeded or the process has ended.
  void check() { watch(); }
  /// Waits up to a second for the process to end by itself.
  void expect_end() noexcept;

  pid_t id() const { return id_; }

 private:
  void watch();
  double cpu_s() const;
  double waited_s() const;

  CallLimits limits_;
  RingMemory ours_, theirs_;
  std::optional<OutputDrain> drain_;
  std::optional<StartingThread> started_by_;
  pid_t id_ = -1;  // -1: ended, and waited for
  RingEnd ring_;
  const char* call_ = "";
  std::chrono::steady_clock::time_point call_began_;
  double cpu_before_s_ = 0;                    // processor time before the call
  std::optional<double> cpu_after_s_;          // and after the last one
  double spent_wall_s_ = 0, spent_cpu_s_ = 0;  // in earlier calls of this decision cycle
};

}  // namespace karst::host
