// Text of any length after a format of std::printf. A buffer of fixed size would cut long names and reasons.
#pragma once
#include <cstdarg>
#include <string>

namespace karst::core {

[[gnu::format(printf, 1, 2)]] std::string format_text(const char* format, ...);
/// The same of arguments that are variadic already.
[[gnu::format(printf, 1, 0)]] std::string format_text_list(const char* format, std::va_list arguments);

}  // namespace karst::core
