#include "sdk/host/process_state.h"

#include <clocale>

namespace karst::host {

ProcessState::ProcessState()
    : c_locale_(std::setlocale(LC_ALL, nullptr)), thread_locale_(uselocale(static_cast<locale_t>(nullptr))) {}

std::string ProcessState::restore() const {
  std::string changed;
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
