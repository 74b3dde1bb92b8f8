// A word of a command line that is printed for people to copy.
#pragma once
#include <string>

namespace karst::core {

/// Quoted for the shell if need be: "plain", "'two words'".
inline std::string shell_word(const std::string& word) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// " --option value"; joined by '=' where the value would be taken for an option. Nothing without a value.
inline std::string shell_option(const std::string& option, const std::string& value) {
  if (value.empty()) return "";
  return " " + (value.starts_with('-') ? shell_word(option + "=" + value) : option + " " + shell_word(value));
}

}  // namespace karst::core
