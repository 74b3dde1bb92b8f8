// Where the command's words go out. What they say comes from files, policies and campaigns of others, so all
// of it is made printable here.
#pragma once
#include <cstdio>
#include <string>

namespace karst {

/// As std::printf, of printable text (core_stack/common/printable.h).
[[gnu::format(printf, 1, 2)]] void print_out(const char* format, ...);
/// The same to standard error, and no longer than a screen or two.
[[gnu::format(printf, 1, 2)]] void print_error(const char* format, ...);

/// In ASCII alone: any terminal prints it as it is, and any reader of JSON finds the same texts in it.
template <class Json>
void print_json(const Json& j) {
  std::fputs((j.dump(2, ' ', true, Json::error_handler_t::replace) + "\n").c_str(), stdout);
}

}  // namespace karst
