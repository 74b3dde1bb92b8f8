// The text output of the command. It includes text from files, policies and campaigns of others, so all of
// it is made printable here.
#pragma once
#include <cstddef>
#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace karst {

/// Like std::printf, but makes the text printable (core_stack/common/printable.h).
[[gnu::format(printf, 1, 2)]] void print_out(const char* format, ...);
/// The same to standard error, cut to a screen or two.
[[gnu::format(printf, 1, 2)]] void print_error(const char* format, ...);
/// The same for sentences: on a terminal, lines end between words, and what goes on begins with `indent`
/// blanks. A file or a pipe gets the text as it is.
[[gnu::format(printf, 3, 4)]] void print_wrapped(std::FILE* to, std::size_t indent, const char* format, ...);

/// How many columns a line has on the terminal that `to` writes to; 0 if it writes to something else.
std::size_t terminal_columns(std::FILE* to);

/// How wide help is: COLUMNS of the environment, or else what the terminal says; 100 where there is none.
std::size_t help_columns();

/// `text` with each line broken between words where it is longer than `columns`; what goes on begins with
/// `indent` blanks. A word that is longer than a line stays whole. 0 columns: no limit.
std::string wrapped(std::string_view text, std::size_t columns, std::size_t indent);

/// Prints JSON in pure ASCII: any terminal prints it unchanged, and any JSON parser reads the same texts.
void print_json(const nlohmann::json& j);
void print_json(const nlohmann::ordered_json& j);

}  // namespace karst
