// The help of the commands, wrapped to the terminal.
#pragma once
#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

namespace karst::tools {

/// Lines end between words at `columns`; indented lines, such as examples, stay as they are.
class HelpFormatter : public CLI::Formatter {
 public:
  explicit HelpFormatter(std::size_t columns) : columns_(columns) {}
  std::string make_description(const CLI::App* command) const override;
  std::string make_footer(const CLI::App* command) const override;
  std::string make_usage(const CLI::App* command, std::string name) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_option_usage(const CLI::Option* option) const override;
  /// By the first line of its description: the rest is the help of the command itself.
  std::string make_subcommand(const CLI::App* command) const override;

 private:
  std::string entry(const std::string& name, const std::string& text) const;

  std::size_t columns_;
};

}  // namespace karst::tools
