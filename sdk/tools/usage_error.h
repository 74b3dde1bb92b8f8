// What is said about words that are no command line.
#pragma once
#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace karst::tools {

/// The command to which the words lead as far as they are valid.
const CLI::App& reached(const CLI::App& app);

/// Of a word that names no command below `at`: that, a command spelt nearly so, and where to read more.
std::string unknown_command(const CLI::App& at, const std::string& word);

/// A line that names the command, what is wrong and where to read more. CLI11's own messages have its types
/// ("--paper: 1 required FOLDER missing", "shell: fish not in {bash,zsh}").
std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace karst::tools
