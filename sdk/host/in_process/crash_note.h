// A policy that crashes in the host's process takes the host with it: a line on stderr then names the policy,
// the call and the request.
#pragma once
#include <signal.h>

#include <array>
#include <cstddef>
#include <string_view>

namespace karst::host {

/// While it lives, a crash of the calling thread (SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL) writes a line to
/// stderr, prepared here, and ends the process by that signal.
///
/// The notes of several threads may overlap: each thread has a line of its own. The handlers are the
/// process's; they go with the last note. A handler that somebody else has installed stays. Sanitizers have
/// their own: with them this does nothing.
class CrashNote {
 public:
  /// `text`: what is said, without the signal and the end of the line; long ones are cut. Empty: no note. To
  /// be destroyed on the same thread.
  explicit CrashNote(std::string_view text);
  ~CrashNote();
  CrashNote(const CrashNote&) = delete;
  CrashNote& operator=(const CrashNote&) = delete;

  /// For the signal handler: writes the line, with the signal's name. Async-signal-safe.
  void write(int signal);

 private:
  static constexpr std::size_t kMaxText = 480;

  std::array<char, kMaxText + 32> line_{};
  std::size_t size_ = 0;
  bool active_ = false;
  CrashNote* outer_ = nullptr;  // of this thread
  stack_t stack_before_{};      // the thread's alternate stack
};

}  // namespace karst::host
