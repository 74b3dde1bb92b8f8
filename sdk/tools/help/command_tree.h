// The commands of `karst` as values, read from the tree of CLI11: what completions and manual pages are made
// from.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "core_stack/common/enum_names.h"

namespace CLI {
class App;
}

namespace karst::tools {

/// What a shell completes.
enum class ValueKind { none, file, folder, policy, policy_or_file, metric, setting, choice, other };
constexpr auto names_of(ValueKind) {
  using enum ValueKind;
  return std::to_array<core::Named<ValueKind>>({{none, "none"},
                                                {file, "file"},
                                                {folder, "folder"},
                                                {policy, "policy"},
                                                {policy_or_file, "policy_or_file"},
                                                {metric, "metric"},
                                                {setting, "setting"},
                                                {choice, "choice"},
                                                {other, "other"}});
}

/// An option, or an argument that stands without a name.
struct CommandOption {
  std::vector<std::string> names;    // "-o", "--out"; of an argument none
  std::string argument;              // name of the argument in help
  ValueKind kind = ValueKind::none;  // none: a flag
  std::string value;                 // what help shows for the value, such as FILE
  std::vector<std::string> choices;  // of a choice or a metric
  std::string keys;                  // of a setting: the words behind `karst` that list the keys
  std::string default_text, help;
  bool required = false;
  bool repeats = false;  // may be given several times
  bool several = false;  // takes several values at once
};

struct Command {
  std::vector<std::string> words;  // "karst", "policy", "new"
  std::string summary;             // first line of the description, without its full stop
  std::string details;             // the rest of the description
  std::vector<CommandOption> options, arguments;
  std::vector<std::string> below;  // names of the commands of a group
};

/// `root` and all commands below it that help shows, each before those below it.
std::vector<Command> commands_of(const CLI::App& root);

/// "karst policy new", with another separator if need be.
std::string joined(const std::vector<std::string>& words, const std::string& separator = " ");

}  // namespace karst::tools
