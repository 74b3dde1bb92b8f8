// What a plugin may leave behind in the process: output, threads, handlers of signals, open files.
#pragma once
#include <signal.h>

#include <array>
#include <string>
#include <vector>

#include "sdk/host/plugin/process_state.h"

namespace karst::check {

class ProcessView {
 public:
  ProcessView();
  // Each: "" or what is different now.
  std::string output_since() const;   // of standard output and standard error, which are files
  std::string threads_since() const;  // waits a little for those that are just ending
  std::string signals_since() const;
  std::string leftovers_since() const;  // files, working folder, file mode mask, environment

 private:
  static constexpr int kSignals = 32;
  std::array<long, 2> output_bytes_;
  std::size_t threads_;
  std::array<struct sigaction, kSignals> actions_;
  sigset_t mask_;
  std::vector<std::string> files_;
  std::string folder_, environment_;
  mode_t umask_;
};

/// Threads of this process.
std::size_t thread_count();
/// Bytes the heap has given out.
std::size_t heap_bytes();
/// Memory held, and the most it has been since `reset_peak`.
std::size_t resident_bytes();
std::size_t peak_bytes();
void reset_peak();

}  // namespace karst::check
