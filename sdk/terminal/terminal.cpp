#include "sdk/terminal/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "core_stack/common/character_count.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/printable.h"

namespace karst {
namespace {

constexpr std::size_t kMaxErrorBytes = 8000;
constexpr std::size_t kMinColumns = 20, kUsualColumns = 80;  // a terminal may say 0
constexpr std::size_t kHelpColumns = 100;                    // without a terminal

std::string formatted(const char* format, std::va_list arguments) {
  return core::printable(core::format_text_list(format, arguments));
}

std::string cut(std::string text) {
  if (text.size() <= kMaxErrorBytes) return text;
  return text.substr(0, kMaxErrorBytes) + "... (" + std::to_string(text.size()) + " bytes)\n";
}

void put(std::FILE* to, const std::string& text) { std::fwrite(text.data(), 1, text.size(), to); }

std::string wrapped_line(std::string_view line, std::size_t columns, std::size_t indent) {
  std::string out;
  std::size_t used = 0;
  for (bool first = true; !line.empty(); first = false) {
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size()),
                      end = std::min(line.find(' ', begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    used += core::character_count(line.substr(0, end));
    if (first || word.empty() || used <= columns) {
      out += line.substr(0, end);
    } else {
      out += "\n" + std::string(indent, ' ');
      out += word;
      used = indent + core::character_count(word);
    }
    line.remove_prefix(end);
  }
  return out;
}

}  // namespace

std::size_t terminal_columns(std::FILE* to) {
  const int file = fileno(to);
  if (isatty(file) != 1) return 0;
  winsize size{};
  return ioctl(file, TIOCGWINSZ, &size) == 0 && size.ws_col >= kMinColumns ? size.ws_col : kUsualColumns;
}

std::size_t help_columns() {
  const char* const said = std::getenv("COLUMNS");
  const std::string_view text = said == nullptr ? "" : said;
  std::size_t columns = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), columns);
  if (error == std::errc() && end == text.data() + text.size() && columns >= kMinColumns) return columns;
  const std::size_t terminal = terminal_columns(stdout);
  return terminal > 0 ? terminal : kHelpColumns;
}

std::string wrapped(std::string_view text, std::size_t columns, std::size_t indent) {
  if (columns == 0) return std::string(text);
  std::string out;
  for (;;) {
    const std::size_t end = text.find('\n');
    out += wrapped_line(text.substr(0, end), columns, indent);
    if (end == std::string_view::npos) return out;
    out += '\n';
    text.remove_prefix(end + 1);
  }
}

void print_json(const nlohmann::json& j) {
  put(stdout, core::json_text(j, 2, core::JsonCharacters::ascii) + "\n");
}

void print_json(const nlohmann::ordered_json& j) {
  put(stdout, core::json_text(j, 2, core::JsonCharacters::ascii) + "\n");
}

void print_out(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  const std::string text = formatted(format, arguments);
  va_end(arguments);
  put(stdout, text);
}

void print_error(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  const std::string text = cut(formatted(format, arguments));
  va_end(arguments);
  put(stderr, text);
}

void print_wrapped(std::FILE* to, std::size_t indent, const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  const std::string text = formatted(format, arguments);
  va_end(arguments);
  put(to, wrapped(to == stderr ? cut(text) : text, terminal_columns(to), indent));
}

}  // namespace karst
