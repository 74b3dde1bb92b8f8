#include "sdk/host/boundary/text.h"

#include <algorithm>
#include <cstring>

namespace karst::host {
namespace {

/// Length of the well-formed sequence at the front of `s`, 0 if there is none.
std::size_t sequence_length(std::string_view s) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(s[i]); };
  const auto follows = [&](std::size_t i, unsigned low = 0x80, unsigned high = 0xBF) {
    return i < s.size() && byte(i) >= low && byte(i) <= high;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return follows(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const unsigned low = first == 0xE0 ? 0xA0 : 0x80, high = first == 0xED ? 0x9F : 0xBF;
    return follows(1, low, high) && follows(2) ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const unsigned low = first == 0xF0 ? 0x90 : 0x80, high = first == 0xF4 ? 0x8F : 0xBF;
    return follows(1, low, high) && follows(2) && follows(3) ? 4 : 0;
  }
  return 0;
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

}  // namespace

bool is_utf8(std::string_view s) {
  while (!s.empty()) {
    const std::size_t n = sequence_length(s);
    if (n == 0) return false;
    s.remove_prefix(n);
  }
  return true;
}

std::string fault_of(const karst_text_t& text, std::uint64_t limit) {
  if (text.length == 0) return "";
  if (text.data == nullptr) return "has a length but no bytes";
  if (text.length > limit)
    return "is " + std::to_string(text.length) + " bytes long, the limit is " + std::to_string(limit);
  const std::string_view s(text.data, text.length);
  if (!is_utf8(s)) return "is not valid UTF-8";
  if (std::any_of(s.begin(), s.end(), is_control)) return "has control characters or more than one line";
  return "";
}

std::string cleaned(const karst_text_t& text, std::uint64_t limit) {
  std::string out;
  if (text.data == nullptr) return out;
  std::string_view s(text.data, std::min(text.length, limit));
  while (!s.empty()) {
    const std::size_t n = sequence_length(s);
    if (n == 0 || is_control(s[0]))
      out += s[0] == '\n' || s[0] == '\t' ? ' ' : '?';
    else
      out += s.substr(0, n);
    s.remove_prefix(std::max<std::size_t>(n, 1));
  }
  return out;
}

void fill_error(karst_error_t* error, std::int32_t code, std::string_view text) {
  if (error == nullptr) return;
  error->code = code;
  const std::size_t n = std::min<std::size_t>(text.size(), KARST_ERROR_TEXT_SIZE - 1);
  std::memcpy(error->text, text.data(), n);
  error->text[n] = '\0';
}

std::string text_of(const karst_error_t& error) {
  const karst_text_t text{error.text, strnlen(error.text, KARST_ERROR_TEXT_SIZE)};
  const std::string out = cleaned(text, KARST_ERROR_TEXT_SIZE);
  return out.empty() ? "it gave no reason (code " + std::to_string(error.code) + ")" : out;
}

}  // namespace karst::host
