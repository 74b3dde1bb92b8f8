// Ctrl-C and its like are asked about, not obeyed on the spot: what is under way is ended in good order.
#pragma once
#include <atomic>
#include <csignal>

namespace karst::tools {

constexpr int kInterrupted = 130;  // exit code, as a shell has it for a program that Ctrl-C ended

/// From here on SIGINT, SIGTERM and, unless under nohup, SIGHUP set the flag that is returned and do nothing
/// else. A reader that goes away stops nothing.
inline const std::atomic<bool>& watch_for_interrupt() {
  static std::atomic<bool> interrupted{false};  // a handler reaches nothing but statics
  static const auto note = [](int) { interrupted = true; };
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, note);
  if (std::signal(SIGHUP, note) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  return interrupted;
}

}  // namespace karst::tools
