// Text of values: by a printf format, which the compiler checks, at any length (a buffer of fixed size would
// cut long names and reasons); and of a number as short as it can be.
#pragma once
#include <array>
#include <charconv>
#include <cstdarg>
#include <string>

namespace karst::core {

[[gnu::format(printf, 1, 2)]] std::string format_text(const char* format, ...);
/// The same of arguments that are variadic already.
[[gnu::format(printf, 1, 0)]] std::string format_text_list(const char* format, std::va_list arguments);

/// Shortest text that reads back as the same double.
inline std::string shortest_text(double v) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), v).ptr;
  return {buffer.data(), end};
}

}  // namespace karst::core
