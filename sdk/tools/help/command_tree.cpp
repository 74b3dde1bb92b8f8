#include "sdk/tools/help/command_tree.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "sdk/evaluation/metrics/metric_definitions.h"
#include "sdk/tools/help/value_types.h"
#include "sdk/tools/help/value_words.h"

namespace karst::tools {
namespace {

/// CLI11 shows the values allowed as "TEXT:{ply,stl}".
std::vector<std::string> choices_in(const std::string& type) {
  const std::size_t open = type.find('{'), close = type.find('}', std::min(open, type.size()));
  if (open == std::string::npos || close == std::string::npos) return {};
  std::istringstream in(type.substr(open + 1, close - open - 1));
  std::vector<std::string> choices;
  for (std::string choice; std::getline(in, choice, ',');) choices.push_back(choice);
  return choices;
}

/// Those by which one can compare.
std::vector<std::string> metrics() {
  std::vector<std::string> names;
  for (const evaluation::MetricDefinition& m : evaluation::metric_definitions())
    if (m.better != evaluation::Better::neither) names.emplace_back(m.name);
  return names;
}

/// A command that lists the keys of its settings does so with --keys or in its help; the others take those of
/// a mission.
std::string keys_of(const Command& command) {
  const std::string own = joined({command.words.begin() + 1, command.words.end()});
  for (const CommandOption& option : command.options)
    for (const std::string& name : option.names)
      if (name == "--keys") return own + " --keys";
  if (command.details.find("Keys for --set") != std::string::npos) return own + " --help";
  return "fly --keys";
}

ValueKind kind_of(const CommandOption& option) {
  if (option.value == kFile) return ValueKind::file;
  if (option.value == kFolder) return ValueKind::folder;
  if (option.value == kPolicy) return ValueKind::policy;
  if (option.value == kPolicyOrFile) return ValueKind::policy_or_file;
  if (option.value == kMetric) return ValueKind::metric;
  if (option.value == kSetting) return ValueKind::setting;
  return option.choices.empty() ? ValueKind::other : ValueKind::choice;
}

CommandOption option_of(const CLI::Option& from) {
  CommandOption out;
  for (const std::string& name : from.get_snames()) out.names.push_back("-" + name);
  for (const std::string& name : from.get_lnames()) out.names.push_back("--" + name);
  if (out.names.empty()) out.argument = from.get_name(true);
  out.help = from.get_description();
  out.required = from.get_required();
  if (from.get_items_expected_max() == 0) return out;  // a flag
  const std::string type = from.get_type_name();
  out.value = value_word(type.substr(0, type.find(':')));
  out.choices = choices_in(type);
  out.kind = kind_of(out);
  if (out.kind == ValueKind::metric) out.choices = metrics();
  out.default_text = from.get_default_str();
  out.repeats = from.get_items_expected_max() > 1;
  out.several = out.repeats && from.get_allow_extra_args();
  return out;
}

void add(const CLI::App& app, std::vector<std::string> words, std::vector<Command>& out) {
  words.push_back(app.get_name());
  Command command;
  command.words = words;
  const std::string description = app.get_description();
  const std::size_t line = std::min(description.find('\n'), description.size()),
                    rest = std::min(description.find_first_not_of('\n', line), description.size());
  command.summary = description.substr(0, line);
  if (command.summary.ends_with('.')) command.summary.pop_back();
  if (const std::string name = words.back() + ": "; command.summary.starts_with(name))
    command.summary.erase(0, name.size());
  command.details = description.substr(rest);
  if (const std::string footer = app.get_footer(); !footer.empty())
    command.details += (command.details.empty() ? "" : "\n\n") + footer;
  for (const CLI::Option* option :
       app.get_options([](const CLI::Option* o) { return !o->get_group().empty(); })) {
    const CommandOption value = option_of(*option);
    (value.names.empty() ? command.arguments : command.options).push_back(value);
  }
  for (CommandOption& option : command.options)
    if (option.kind == ValueKind::setting) option.keys = keys_of(command);
  const std::vector<const CLI::App*> below =
      app.get_subcommands([](const CLI::App* a) { return !a->get_group().empty(); });
  for (const CLI::App* b : below) command.below.push_back(b->get_name());
  out.push_back(command);
  for (const CLI::App* b : below) add(*b, words, out);
}

}  // namespace

std::vector<Command> commands_of(const CLI::App& root) {
  std::vector<Command> out;
  add(root, {}, out);
  return out;
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : separator) + word;
  return out;
}

}  // namespace karst::tools
