#include "core_stack/common/format_text.h"

#include <algorithm>
#include <cstdio>

namespace karst::core {

std::string format_text_list(const char* format, std::va_list arguments) {
  std::va_list again;
  va_copy(again, arguments);
  std::string text(static_cast<std::size_t>(std::max(0, std::vsnprintf(nullptr, 0, format, arguments))),
                   '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  return text;
}

std::string format_text(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  std::string text = format_text_list(format, arguments);
  va_end(arguments);
  return text;
}

}  // namespace karst::core
