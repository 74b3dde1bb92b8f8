// Text in the encodings that survey files declare.
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace karst::survey {

/// The name by which iconv knows the encoding that a Therion file declares, in any case; none if Therion
/// knows no such encoding.
std::optional<std::string> known_encoding(std::string_view declared);

struct Decoded {
  std::string text;       // UTF-8
  bool replaced = false;  // bytes that stand for no character became '?'
};
Decoded to_utf8(std::string_view bytes, const std::string& encoding);

}  // namespace karst::survey
