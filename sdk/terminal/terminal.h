// The text output of the command. It includes text from files, policies and campaigns of others, so all of
// it is made printable here.
#pragma once
#include <cstdio>
#include <string>

namespace karst {

/// Like std::printf, but makes the text printable (core_stack/common/printable.h).
[[gnu::format(printf, 1, 2)]] void print_out(const char* format, ...);
/// The same to standard error, cut to a screen or two.
[[gnu::format(printf, 1, 2)]] void print_error(const char* format, ...);

/// Prints JSON in pure ASCII: any terminal prints it unchanged, and any JSON parser reads the same texts.
template <class Json>
void print_json(const Json& j) {
  std::fputs((j.dump(2, ' ', true, Json::error_handler_t::replace) + "\n").c_str(), stdout);
}

}  // namespace karst
