// The progress of work that goes on step by step.
#pragma once
#include <unistd.h>

#include <cstdio>
#include <string>

#include "sdk/terminal/terminal.h"

namespace karst::tools {

/// On standard error: one line that is rewritten on a terminal, otherwise one line for each new step.
class StepProgress {
 public:
  StepProgress() = default;
  ~StepProgress() { end(); }
  StepProgress(const StepProgress&) = delete;
  StepProgress& operator=(const StepProgress&) = delete;

  void operator()(const char* step, double fraction) {
    const bool fresh = last_ != step;
    last_ = step;
    if (terminal_)
      std::fprintf(stderr, "\r%-24s %3.0f %%", step, 100 * fraction);
    else if (fresh)
      print_error("%s\n", step);
  }
  /// Takes the line away.
  void end() {
    if (terminal_ && !last_.empty()) std::fprintf(stderr, "\r%30s\r", "");
    last_.clear();
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) == 1;
  std::string last_;
};

}  // namespace karst::tools
