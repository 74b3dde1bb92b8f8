// Ctrl-C and similar signals request an orderly shutdown instead of ending the process at once.
// A user who cannot wait sends the signal twice.
#pragma once
#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>

namespace karst::tools {

constexpr int kInterrupted = 130;  // exit code of a shell for a program that Ctrl-C ended

/// From now on the first SIGINT, SIGTERM or, unless under nohup, SIGHUP only sets the returned flag; a second
/// SIGINT or SIGTERM, half a second later or more, ends the process at once. A closed pipe does not stop the
/// process, nor does a file size limit (ulimit -f): writing fails instead.
inline const std::atomic<bool>& watch_for_interrupt() {
  static std::atomic<bool> interrupted{false};  // a signal handler can only access statics
  static std::atomic<std::int64_t> first_ns{0};
  static const auto note = [](int signal) {
    constexpr std::int64_t kOneSignal_ns = 500'000'000;  // timeout(1) sends its signal twice at once
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    const std::int64_t now_ns = std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
    if (!interrupted.exchange(true)) {
      first_ns = now_ns;
    } else if (signal != SIGHUP && now_ns - first_ns > kOneSignal_ns) {
      std::signal(signal, SIG_DFL);
      std::raise(signal);
    }
  };
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, note);
  if (std::signal(SIGHUP, note) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  return interrupted;
}

}  // namespace karst::tools
