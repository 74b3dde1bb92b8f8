// "1 cave", "2 caves".
#pragma once
#include <cstddef>
#include <string>

namespace karst::core {

inline std::string counted(std::size_t n, const std::string& word) {
  return std::to_string(n) + " " + word + (n == 1 ? "" : "s");
}

}  // namespace karst::core
