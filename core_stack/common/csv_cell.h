// A cell of a CSV file as RFC 4180 has it, with LF as the end of a line.
#pragma once
#include <string>

namespace karst::core {

/// `text` as it is, or in quotes with its own quotes doubled if it contains a comma, a quote or a line end.
/// Other control characters, which a terminal would obey, become blanks.
inline std::string csv_cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool control = static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\r' && c != '\t';
    if (c == '"') out += '"';
    out += control ? ' ' : c;
  }
  return out.find_first_of(",\"\r\n") == std::string::npos ? out : '"' + out + '"';
}

}  // namespace karst::core
