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

/// At most so many characters from the beginning.
inline std::string_view first_characters(std::string_view text, std::size_t count) {
  std::size_t bytes = 0;
  for (std::size_t seen = 0; bytes < text.size(); ++bytes)
    if (character_count(text.substr(bytes, 1)) == 1 && ++seen > count) break;
  return text.substr(0, bytes);
}

}  // namespace karst::core
