// What a plugin may change in the process and must not: the locale, where a changed decimal point would
// corrupt every file written after it, and the arithmetic of the thread that calls it: a library linked with
// -ffast-math has subnormal numbers flushed to zero as soon as it is opened.
#pragma once
#include <locale.h>

#include <cfenv>
#include <locale>
#include <string>

namespace karst::host {

/// Remembers all that; `restore` puts it back and says what had been changed ("" if nothing). Between a
/// change of the locale and its restoration other threads see it: a plugin that does this is told off in the
/// log. To be restored on the thread that made it.
class ProcessState {
 public:
  ProcessState();
  std::string restore() const;

 private:
  /// How this thread computes.
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
