// Process state that a plugin can change but must not: the locale, where a changed decimal point would
// corrupt every file written afterwards, and the floating-point environment of the calling thread: a library
// linked with -ffast-math flushes subnormal numbers to zero as soon as it is opened.
#pragma once
#include <locale.h>

#include <cfenv>
#include <locale>
#include <string>

namespace karst::host {

/// Saves that state; `restore` restores it and returns which parts had changed ("" if none). Between a change
/// of the locale and its restoration other threads see it: the log warns of a plugin that does this. To be
/// restored on the thread that saved it.
class ProcessState {
 public:
  ProcessState();
  std::string restore() const;

 private:
  /// The floating-point environment of this thread.
  struct Arithmetic {
    int rounding, traps;
    bool subnormals;
    bool operator==(const Arithmetic&) const = default;
  };
  static Arithmetic arithmetic();

  std::string c_locale_;
  std::locale cpp_locale_;
  locale_t thread_locale_;
  Arithmetic arithmetic_;
  std::fenv_t environment_;
};

}  // namespace karst::host
