// Side effects of a plugin on the process: output, threads, signal handlers, open files.
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
  // Each returns "" or a description of the difference.
  std::string output_since() const;   // of standard output and standard error, which are files
  std::string threads_since() const;  // waits briefly for threads that are just ending
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

/// Number of threads of this process.
std::size_t thread_count();
/// Bytes allocated on the heap.
std::size_t heap_bytes();
/// Resident memory, and its maximum since `reset_peak`.
std::size_t resident_bytes();
std::size_t peak_bytes();
void reset_peak();

}  // namespace karst::check
