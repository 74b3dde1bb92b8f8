// Text that came from a plugin: bounded, valid UTF-8, one line.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "sdk/abi/karst_abi_types.h"

namespace karst::host {

constexpr std::uint64_t kLineLimit = 240;      // bytes of a goal's why, a reason, a drawn text
constexpr std::uint64_t kLogLineLimit = 1000;  // bytes of a line of the log

/// True for well-formed UTF-8 (Unicode 15, table 3-7: no overlong forms, no surrogates).
bool is_utf8(std::string_view s);

/// "" if `text` is one line of UTF-8 of at most `limit` bytes, otherwise what is wrong with it.
std::string fault_of(const karst_text_t& text, std::uint64_t limit);

/// A copy that is always one line of UTF-8: cut at the limit, invalid bytes replaced by '?'.
std::string cleaned(const karst_text_t& text, std::uint64_t limit);

/// The bytes as they are.
inline std::string string_of(const karst_text_t& t) {
  return t.length == 0 ? "" : std::string(t.data, t.length);
}

/// A view of `s`, which must outlive it.
inline karst_text_t view_of(std::string_view s) { return {s.data(), s.size()}; }

void fill_error(karst_error_t* error, std::int32_t code, std::string_view text);
/// The callee's reason, read safely whatever the struct contains.
std::string text_of(const karst_error_t& error);

}  // namespace karst::host
