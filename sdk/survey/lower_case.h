// Words and file names in small letters, where case does not count. Letters beyond ASCII stay: a locale must
// not change what a survey means.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace karst::survey {

inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

/// ".dat" of "Cave.DAT".
inline std::string ending_of(const std::filesystem::path& file) {
  return lower_case(file.extension().string());
}

}  // namespace karst::survey
