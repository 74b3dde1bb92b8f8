#include "sdk/tools/usage_error.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "core_stack/common/options.h"
#include "sdk/tools/help/value_words.h"

namespace karst::tools {
namespace {

/// "karst policy new".
std::string words_to(const CLI::App& app) {
  std::string words = app.get_name();
  for (const CLI::App* above = app.get_parent(); above != nullptr; above = above->get_parent())
    words = above->get_name() + " " + words;
  return words;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& names) {
  const std::string near = core::nearest_name(word, names);
  const std::size_t length = word.size() - std::min(word.find_first_not_of('-'), word.size());
  const bool is_slip =
      !near.empty() && core::edit_distance(word, near) <= std::max<std::size_t>(1, length / 3);
  return is_slip ? "; did you mean " + near + "?" : ";";
}

/// Of a word that names no command below `at`.
std::string no_command(const CLI::App& at, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : at.get_subcommands([](const CLI::App*) { return true; }))
    if (!command->get_group().empty()) names.push_back(command->get_name());
  return "\"" + word + "\" is no command" + suggestion(word, names);
}

/// Of the first word that names no command where one was expected; "" if all words so far are valid.
std::string wrong_command(const CLI::App& at) {
  const std::vector<std::string> rest = at.remaining();
  if (at.get_require_subcommand_min() == 0 || rest.empty() || rest.front().starts_with("--")) return "";
  return no_command(at, rest.front());
}

/// Of the first word that is an option of no command; "" if there is none.
std::string wrong_option(const CLI::App& at) {
  const std::vector<std::string> rest = at.remaining();
  const auto wrong =
      std::find_if(rest.begin(), rest.end(), [](const std::string& word) { return word.starts_with("--"); });
  if (wrong == rest.end()) return "";
  std::vector<std::string> names;
  for (const CLI::Option* option : at.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  const std::string given = wrong->substr(0, wrong->find('='));
  return "\"" + given + "\" is no option of " + words_to(at) + suggestion(given, names);
}

/// A number as std::to_string writes it, without the zeros at its end.
std::string short_number(std::string text) {
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

struct Parts {
  std::string before, after;
};

/// What stands on both sides of a separator; nothing on both if it is not there.
Parts parts_of(const std::string& text, const std::string& separator) {
  const std::size_t at = text.find(separator);
  if (at == std::string::npos) return {};
  return {text.substr(0, at), text.substr(at + separator.size())};
}

std::string got(const std::string& value) { return ", got \"" + value + "\""; }

/// A message of CLI11 in words.
std::string in_words(const std::string& message) {
  if (message.ends_with(" is required")) {
    const std::string name = message.substr(0, message.size() - 12);
    return std::string(name.starts_with('-') ? "option " : "argument ") + name + " is missing";
  }
  const auto [what, problem] = parts_of(message, ": ");
  if (what.empty()) return message;
  if (what == "Could not convert") {
    const auto [name, value] = parts_of(problem, " = ");
    return name + ": expected another kind of value" + got(value);
  }
  if (const auto [value, choices] = parts_of(problem, " not in {"); !choices.empty())
    return what + ": expected " + choice_words("{" + choices, " or ") + got(value);
  if (const auto [value, range] = parts_of(problem, " not in range "); value.starts_with("Value ")) {
    const auto [low, high] = parts_of(range, " to ");
    return what + ": expected a number from " + short_number(low) + " to " + short_number(high) +
           got(value.substr(6));
  }
  if (const auto [count, type] = parts_of(problem, " required "); type.ends_with(" missing"))
    return what + ": needs a value, " + type_words(type.substr(0, type.size() - 8));
  return message;
}

}  // namespace

const CLI::App& reached(const CLI::App& app) {
  const CLI::App* at = &app;
  // An option group is a subcommand without a name.
  while (!at->get_subcommands().empty() && !at->get_subcommands().front()->get_name().empty())
    at = at->get_subcommands().front();
  return *at;
}

std::string unknown_command(const CLI::App& at, const std::string& word) {
  return no_command(at, word) + " `" + words_to(at) + " --help` says more";
}

std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& at = reached(app);
  const std::string words = words_to(at);
  std::string wrong = wrong_command(at);
  if (wrong.empty()) wrong = wrong_option(at);
  if (wrong.empty() && std::string(error.what()).starts_with("The following argument") &&
      !at.remaining().empty())
    wrong = words + ": \"" + at.remaining().front() + "\" is more than it takes;";
  if (wrong.empty()) wrong = words + ": " + in_words(error.what()) + ";";
  return "karst: " + wrong + " `" + words + " --help` says more\n";
}

}  // namespace karst::tools
