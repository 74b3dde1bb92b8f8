#include <map>

#include "sdk/tools/help/completion.h"

namespace karst::tools {
namespace {

constexpr const char* kBashHead = R"bash(# Completion of karst for bash, as `karst completion bash` writes it.

# The policies that the karst which is typed can fly; a line of its list is "ID VERSION".
_karst_policies() {
  "$1" policy list 2>/dev/null | sed -n 's/^\([^ :]*\) [^ ]*$/\1/p'
}

# The keys of settings: karst as typed, the words that list them. A line is "  KEY = VALUE", help follows.
_karst_keys() {
  "$1" $2 2>/dev/null | sed -n 's/^  \([a-z][^ ]*\) = .*/\1=/p'
}

# The values of the key $3, where there is a choice.
_karst_key_values() {
  "$1" $2 2>/dev/null |
    sed -n "/^  $3 = /{n;s/.*(one of \(.*\))\$/\1/p;s/.*(true or false)\$/true false/p}" 2>/dev/null
}

# Fills COMPREPLY: kind of value, words to choose from, what is typed of it, karst as typed, the key set.
_karst_values() {
  case "$1" in
    file | folder | policy_or_file) compopt -o filenames 2>/dev/null ;;
  esac
  case "$1" in
    choice) mapfile -t COMPREPLY < <(compgen -W "$2" -- "$3") ;;
    file) mapfile -t COMPREPLY < <(compgen -f -- "$3") ;;
    setting)
      compopt -o nospace 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -W "$(_karst_keys "$4" "$2")" -- "$3")
      ;;
    key_value) mapfile -t COMPREPLY < <(compgen -W "$(_karst_key_values "$4" "$2" "$5")" -- "$3") ;;
    folder) mapfile -t COMPREPLY < <(compgen -d -- "$3") ;;
    policy) mapfile -t COMPREPLY < <(compgen -W "$(_karst_policies "$4")" -- "$3") ;;
    policy_or_file) mapfile -t COMPREPLY < <(compgen -W "$(_karst_policies "$4")" -- "$3"; compgen -f -- "$3") ;;
  esac
}

_karst() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
  local command=karst kind= words= options= key= at=0 i
  COMPREPLY=()
  if [[ $current == "=" ]]; then # bash takes --out=FILE for three words
    current= at=1
  elif [[ $before == "=" ]]; then
    before=${COMP_WORDS[COMP_CWORD - 2]} at=2
  fi
  if ((at > 0 && COMP_CWORD > at + 1)) && [[ $before != -* ]]; then # and --set KEY=VALUE for four
    key=$before before=${COMP_WORDS[COMP_CWORD - at - 1]}
    [[ $before == "=" ]] && before=${COMP_WORDS[COMP_CWORD - at - 2]}
  fi
)bash";

constexpr const char* kBashTail = R"bash(  if [[ $current == -* ]]; then
    kind=choice words=$options
  fi
  if [[ -n $key && $kind == setting ]]; then
    kind=key_value
  fi
  _karst_values "$kind" "$words" "$current" "${COMP_WORDS[0]}" "$key"
}
complete -F _karst karst
)bash";

std::string quoted(const std::string& text) { return '"' + text + '"'; }

/// What is assigned where a value of this option or argument stands.
std::string assignment(const CommandOption& option) {
  if (option.kind == ValueKind::setting) return "kind=setting words=" + quoted(option.keys);
  if (!option.choices.empty()) return "kind=choice words=" + quoted(joined(option.choices));
  return std::string("kind=") + core::name_of(option.kind);
}

/// Lines of a `case` over "COMMAND OPTION"; `counts` says which options count.
template <class Predicate>
std::string option_cases(const std::vector<Command>& commands, const std::string& indent, Predicate counts) {
  std::map<std::string, std::vector<std::string>> patterns;  // by what is assigned
  for (const Command& command : commands)
    for (const CommandOption& option : command.options)
      if (counts(option))
        for (const std::string& name : option.names)
          patterns[assignment(option)].push_back(quoted(joined(command.words) + " " + name));
  std::string out;
  for (const auto& [assigned, of] : patterns) {
    out += indent + joined(of, " | \\\n" + indent + "  ") + ")\n";
    out += indent + "  " + assigned + " ;;\n";
  }
  return out;
}

/// What stands behind a command: one of its own commands, or its argument; and its options.
std::string command_cases(const std::vector<Command>& commands) {
  std::string out;
  for (const Command& command : commands) {
    std::vector<std::string> options;
    for (const CommandOption& option : command.options)
      options.insert(options.end(), option.names.begin(), option.names.end());
    out += "      " + quoted(joined(command.words)) + ")\n        ";
    if (!command.below.empty())
      out += "kind=choice words=" + quoted(joined(command.below)) + " ";
    else if (!command.arguments.empty())
      out += assignment(command.arguments.front()) + " ";
    out += "options=" + quoted(joined(options)) + " ;;\n";
  }
  return out;
}

}  // namespace

std::string bash_completion(const std::vector<Command>& commands) {
  std::vector<std::string> below_karst;
  for (const Command& command : commands)
    if (command.words.size() > 1) below_karst.push_back(quoted(joined(command.words)));
  std::string out = kBashHead;
  out += "  for ((i = 1; i < COMP_CWORD; ++i)); do\n    case \"$command ${COMP_WORDS[i]}\" in\n      " +
         joined(below_karst, " | \\\n        ") +
         ")\n        command+=\" ${COMP_WORDS[i]}\" ;;\n    esac\n  done\n";
  out += "  case \"$command $before\" in\n" +
         option_cases(commands, "    ", [](const CommandOption& o) { return o.kind != ValueKind::none; }) +
         "  esac\n";
  out +=
      "  if [[ -z $kind && $current != -* ]]; then # a further value of an option that takes several\n"
      "    for ((i = COMP_CWORD - 1; i > 0; --i)); do [[ ${COMP_WORDS[i]} == -* ]] && break; done\n"
      "    case \"$command ${COMP_WORDS[i]}\" in\n" +
      option_cases(commands, "      ", [](const CommandOption& o) { return o.several; }) + "    esac\n  fi\n";
  out +=
      "  if [[ -z $kind ]]; then\n    case \"$command\" in\n" + command_cases(commands) + "    esac\n  fi\n";
  return out + kBashTail;
}

}  // namespace karst::tools
