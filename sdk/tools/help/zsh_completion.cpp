#include "sdk/tools/help/completion.h"

namespace karst::tools {
namespace {

constexpr const char* kZshHead = R"zsh(#compdef karst
# Completion of karst for zsh, as `karst completion zsh` writes it: the file _karst in a folder of fpath.

# The policies that this karst can fly; a line of its list is "ID VERSION".
_karst_policies() {
  local -a policies
  policies=(${(f)"$(karst policy list 2>/dev/null | sed -n 's/^\([^ :]*\) [^ ]*$/\1/p')"})
  compadd -a policies
}
_karst_policies_or_files() {
  _karst_policies
  _files
}
# KEY=VALUE; the arguments are the words of karst that list the keys. A line is "  KEY = VALUE", help follows.
_karst_settings() {
  local key=${PREFIX%%=*}
  local -a found
  if compset -P 1 '*='; then
    found=($(karst "$@" 2>/dev/null |
      sed -n "/^  $key = /{n;s/.*(one of \(.*\))\$/\1/p;s/.*(true or false)\$/true false/p}" 2>/dev/null))
    compadd -a found
  else
    found=($(karst "$@" 2>/dev/null | sed -n 's/^  \([a-z][^ ]*\) = .*/\1/p'))
    compadd -S = -a found
  fi
}
)zsh";

/// In single quotes of the shell, with what _arguments and _describe would read.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else if (c == '\n')
      out += ' ';
    else if (c == '\\' || c == '[' || c == ']' || c == ':' || c == '$' || c == '`')
      out += std::string("\\") + c;
    else
      out += c;
  }
  return out;
}

std::string action(const CommandOption& option) {
  switch (option.kind) {
    case ValueKind::file:
      return "_files";
    case ValueKind::folder:
      return "_files -/";
    case ValueKind::policy:
      return "_karst_policies";
    case ValueKind::policy_or_file:
      return "_karst_policies_or_files";
    case ValueKind::setting:
      return " _karst_settings " + option.keys;  // behind a blank: called with these words alone
    case ValueKind::metric:
    case ValueKind::choice:
      return "(" + joined(option.choices) + ")";
    case ValueKind::none:
    case ValueKind::other:
      break;
  }
  return " ";  // nothing to choose from: only the message is shown
}

/// One specification of _arguments for each name of an option: '(-o --out)--out=[help]:FILE:_files'.
std::string option_lines(const CommandOption& option) {
  std::string out;
  for (const std::string& name : option.names) {
    out += "    '";
    out += option.repeats ? "*" : "(" + joined(option.names) + ")";
    out += name;
    if (option.kind != ValueKind::none) out += name.starts_with("--") ? "=" : "+";
    out += "[" + escaped(option.help) + "]";
    if (option.kind != ValueKind::none) out += ":" + escaped(option.value) + ":" + action(option);
    out += "' \\\n";
  }
  return out;
}

/// Two underscores between the words: no other function has such a name.
std::string function_of(const std::vector<std::string>& words) { return "_" + joined(words, "__"); }

std::string function_text(const Command& command, const std::vector<Command>& all) {
  std::string out = "\n" + function_of(command.words) + "() {\n";
  std::string specifications;
  for (const CommandOption& option : command.options) specifications += option_lines(option);
  if (command.below.empty()) {
    for (const CommandOption& argument : command.arguments)
      specifications += "    '" + std::string(argument.repeats ? "*" : "") + ":" +
                        escaped(argument.argument) + ":" + action(argument) + "' \\\n";
    return out + "  _arguments -s \\\n" + specifications + "    && return\n}\n";
  }
  std::string below, cases;
  for (const std::string& name : command.below) {
    std::vector<std::string> words = command.words;
    words.push_back(name);
    for (const Command& c : all)
      if (c.words == words) below += "        '" + name + ":" + escaped(c.summary) + "'\n";
    cases += "        " + name + ") " + function_of(words) + " ;;\n";
  }
  return out + "  local context state state_descr line\n  local -a below\n  typeset -A opt_args\n" +
         "  _arguments -C \\\n" + specifications + "    '1: :->command' \\\n    '*:: :->words' && return\n" +
         "  case $state in\n    command)\n      below=(\n" + below +
         "      )\n      _describe command below ;;\n    words)\n      case $words[1] in\n" + cases +
         "      esac ;;\n  esac\n}\n";
}

}  // namespace

std::string zsh_completion(const std::vector<Command>& commands) {
  std::string out = kZshHead;
  for (const Command& command : commands) out += function_text(command, commands);
  const std::string first = function_of(commands.front().words);
  return out + "\n" + first + " \"$@\"\n";
}

}  // namespace karst::tools
