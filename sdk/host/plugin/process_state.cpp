#include "sdk/host/plugin/process_state.h"

#include <clocale>
#include <limits>

namespace karst::host {

ProcessState::ProcessState()
    : c_locale_(std::setlocale(LC_ALL, nullptr)),
      thread_locale_(uselocale(static_cast<locale_t>(nullptr))),
      arithmetic_(arithmetic()) {
  std::fegetenv(&environment_);
}

ProcessState::Arithmetic ProcessState::arithmetic() {
  volatile double smallest_normal = std::numeric_limits<double>::min();
  return {std::fegetround(), fegetexcept(), smallest_normal / 2 > 0};
}

std::string ProcessState::restore() const {
  std::string changed;
  if (arithmetic() != arithmetic_) {
    std::fesetenv(&environment_);
    changed = "the rules of floating-point arithmetic";
  }
  if (uselocale(thread_locale_) != thread_locale_) changed = "the thread's locale";
  if (std::locale() != cpp_locale_) {
    std::locale::global(cpp_locale_);
    changed = "the global C++ locale";
  }
  if (const std::string now = std::setlocale(LC_ALL, nullptr); now != c_locale_) {
    std::setlocale(LC_ALL, c_locale_.c_str());
    changed = "the process's locale (to " + now + ")";
  }
  return changed;
}

}  // namespace karst::host
