// Ctrl-C and its like are asked about, not obeyed on the spot: what is under way is ended in good order.
// Whoever has no time for that asks twice.
#pragma once
#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>

namespace karst::tools {

constexpr int kInterrupted = 130;  // exit code, as a shell has it for a program that Ctrl-C ended

/// From here on the first SIGINT, SIGTERM or, unless under nohup, SIGHUP sets the flag that is returned and
/// does nothing else; a second SIGINT or SIGTERM, half a second later or more, ends the process at once. A
/// reader that goes away stops nothing, nor does a file that may not grow (ulimit -f): writing it fails.
inline const std::atomic<bool>& watch_for_interrupt() {
  static std::atomic<bool> interrupted{false};  // a handler reaches nothing but statics
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
