#include "sdk/terminal/terminal.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <string>

#include "core_stack/common/printable.h"

namespace karst {
namespace {

constexpr std::size_t kMaxErrorBytes = 8000;

std::string formatted(const char* format, std::va_list arguments) {
  std::va_list again;
  va_copy(again, arguments);
  std::string text(static_cast<std::size_t>(std::max(0, std::vsnprintf(nullptr, 0, format, arguments))),
                   '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  return core::printable(text);
}

}  // namespace

void print_out(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  const std::string text = formatted(format, arguments);
  va_end(arguments);
  std::fwrite(text.data(), 1, text.size(), stdout);
}

void print_error(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  std::string text = formatted(format, arguments);
  va_end(arguments);
  if (text.size() > kMaxErrorBytes)
    text = text.substr(0, kMaxErrorBytes) + "... (" + std::to_string(text.size()) + " bytes)\n";
  std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace karst
