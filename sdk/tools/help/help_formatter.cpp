#include "sdk/tools/help/help_formatter.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "sdk/terminal/terminal.h"
#include "sdk/tools/help/value_words.h"

namespace karst::tools {
namespace {

constexpr std::size_t kLeastText = 20;  // columns beside the names of options

std::string wrapped_sentences(const std::string& text, std::size_t columns) {
  std::string out;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    out += line.starts_with("  ") ? line : wrapped(line, columns, 0);
    if (end < text.size()) out += '\n';
    begin = end + 1;
  }
  return out;
}

}  // namespace

std::string HelpFormatter::make_description(const CLI::App* command) const {
  return wrapped_sentences(Formatter::make_description(command), columns_);
}

std::string HelpFormatter::make_footer(const CLI::App* command) const {
  return wrapped_sentences(Formatter::make_footer(command), columns_);
}

std::string HelpFormatter::make_usage(const CLI::App* command, std::string name) const {
  return "\n" + Formatter::make_usage(command, std::move(name));
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  return entry(make_option_name(option, is_positional) + make_option_opts(option), make_option_desc(option));
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  if (!option->get_option_text().empty()) return " " + option->get_option_text();
  if (option->get_type_size() == 0) return "";  // a flag
  std::string out = type_words(option->get_type_name());
  if (option->get_expected_max() >= CLI::detail::expected_max_vector_size) out += " ...";
  if (option->get_expected_min() > 1) out += ", " + std::to_string(option->get_expected_min()) + " or more";
  if (const std::string value = option->get_default_str(); !value.empty()) out += ", default " + value;
  if (option->get_required()) out += ", required";
  return out.empty() ? "" : " " + out;
}

std::string HelpFormatter::make_option_usage(const CLI::Option* option) const {
  const std::string name = make_option_name(option, true) + (option->get_expected_max() > 1 ? "..." : "");
  return option->get_required() ? name : "[" + name + "]";
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  const std::string description = command->get_description();
  return entry(command->get_display_name(true), description.substr(0, description.find('\n')));
}

std::string HelpFormatter::entry(const std::string& name, const std::string& text) const {
  const std::size_t columns = columns_ > column_width_ ? columns_ - column_width_ : 0;
  std::ostringstream out;
  CLI::detail::format_help(out, name, wrapped(text, std::max(columns, kLeastText), 0), column_width_);
  return out.str();
}

}  // namespace karst::tools
