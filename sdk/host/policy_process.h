// A policy's own process, seen from the host: started, asked, watched, ended.
#pragma once
#include <sys/types.h>

#include <chrono>
#include <string>

#include "sdk/host/call_limits.h"
#include "sdk/host/shared_ring.h"

namespace karst::host {

/// The process is of no more use. `what()` says why, in the same words in every replay.
struct ProcessBroken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The program that such a process runs: lib/karst/karst-policy-child beside this program's folder.
std::string policy_child_program();

class PolicyProcess {
 public:
  /// Starts the program with nothing but its two ends of the rings. Throws core::InputError if it cannot be.
  PolicyProcess(const std::string& program, CallLimits limits);
  /// Ends it, with a signal that cannot be caught.
  ~PolicyProcess();
  PolicyProcess(const PolicyProcess&) = delete;
  PolicyProcess& operator=(const PolicyProcess&) = delete;

  /// From here on the limits of one question count.
  void begin_call(const char* name);
  /// Both throw ProcessBroken.
  void send(std::uint32_t kind, std::span<const std::byte> body);
  RingMessage receive(std::size_t most_bytes);
  /// Throws ProcessBroken if a limit is passed or the process is gone.
  void check() { watch(); }
  /// Waits a while for it to end by itself.
  void expect_end() noexcept;

  pid_t id() const { return id_; }

 private:
  void watch();
  double cpu_s() const;

  CallLimits limits_;
  RingMemory ours_, theirs_;
  pid_t id_ = -1;  // -1: ended, and waited for
  RingEnd ring_;
  const char* call_ = "";
  std::chrono::steady_clock::time_point call_began_;
  double cpu_before_s_ = 0;
};

}  // namespace karst::host
