// What a plugin may change in the whole process and must not: the locale. A changed decimal point would
// corrupt every file written after it.
#pragma once
#include <locale.h>

#include <locale>
#include <string>

namespace karst::host {

/// Remembers the locale; `restore` puts it back and says what had been changed ("" if nothing). Between a
/// change and its restoration other threads see it: a plugin that does this is told off in the log.
class ProcessState {
 public:
  ProcessState();
  std::string restore() const;

 private:
  std::string c_locale_;
  std::locale cpp_locale_;
  locale_t thread_locale_;
};

}  // namespace karst::host
