// Text of others inside XML and HTML, as an element's content or as an attribute in double quotes.
#pragma once
#include <string>
#include <string_view>

#include "core_stack/common/printable.h"

namespace karst::core {

inline std::string xml_text(std::string_view plain) {
  std::string out;
  for (const char c : printable(plain)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace karst::core
