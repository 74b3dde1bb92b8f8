// The progress of work that goes on step by step.
#pragma once
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>

#include "core_stack/common/format_text.h"
#include "core_stack/common/printable.h"
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
      rewrite(core::printable(core::format_text("%-24s %3.0f %%", step, 100 * fraction)));
    else if (fresh)
      print_error("%s\n", step);
  }
  /// Takes the line away.
  void end() {
    if (terminal_ && !last_.empty()) {
      rewrite("");
      std::fputs("\r", stderr);
    }
    last_.clear();
  }

 private:
  /// Over the line that stands there, which may be longer.
  void rewrite(const std::string& line) {
    const std::size_t rest = shown_ - std::min(shown_, line.size());
    std::fprintf(stderr, "\r%s%s", line.c_str(), std::string(rest, ' ').c_str());
    shown_ = line.size();
  }

  bool terminal_ = isatty(STDERR_FILENO) == 1;
  std::string last_;
  std::size_t shown_ = 0;  // characters of the line
};

}  // namespace karst::tools
