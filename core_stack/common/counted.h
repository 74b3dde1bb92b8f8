// "1 cave", "2 caves"; "60,000".
#pragma once
#include <cstddef>
#include <string>

namespace karst::core {

inline std::string counted(std::size_t n, const std::string& word) {
  return std::to_string(n) + " " + word + (n == 1 ? "" : "s");
}

/// With a comma before each group of three digits.
inline std::string grouped(std::size_t n) {
  std::string text = std::to_string(n);
  for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, ",");
  return text;
}

}  // namespace karst::core
