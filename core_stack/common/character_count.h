// How long a text is for whoever reads it.
#pragma once
#include <algorithm>
#include <cstddef>
#include <string_view>

namespace karst::core {

/// Characters, not bytes, of UTF-8: bytes that continue a character do not count.
inline std::size_t character_count(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace karst::core
