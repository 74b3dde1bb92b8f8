// Types and ranges of values in words: CLI11 has "FLOAT:in 0.05 to 1" or "INT:INT in [1 - 256]" for them.
#pragma once
#include <algorithm>
#include <string>

namespace karst::tools {

/// "FLOAT" is a "NUMBER"; what people read already stays.
inline std::string value_word(const std::string& type) {
  if (type == "FLOAT") return "NUMBER";
  if (type == "INT" || type == "UINT") return "INTEGER";
  return type;
}

/// "{ply,stl}" as "ply|stl", with another separator if need be; "" if `text` is no list of choices.
inline std::string choice_words(const std::string& text, const std::string& separator) {
  if (text.size() < 2 || !text.starts_with('{') || !text.ends_with('}')) return "";
  std::string out;
  for (const char c : text.substr(1, text.size() - 2)) out += c == ',' ? separator : std::string(1, c);
  return out;
}

/// A validator's description such as "in 0.05 to 1", "INT in [1 - 256]" or "POSITIVE", as "0.05 to 1".
inline std::string range_words(const std::string& description) {
  if (description == "POSITIVE") return "above 0";
  if (description == "NONNEGATIVE") return "0 or more";
  if (description.starts_with("in ")) return description.substr(3);
  const std::size_t open = description.find(" in ["),
                    between = description.find(" - ", std::min(open, description.size()));
  if (open == std::string::npos || between == std::string::npos || !description.ends_with(']'))
    return description;
  return description.substr(open + 5, between - open - 5) + " to " +
         description.substr(between + 3, description.size() - between - 4);
}

/// A type with its validators: "NUMBER 0.05 to 1", "ply|stl", "FILE".
inline std::string type_words(const std::string& type) {
  std::size_t end = std::min(type.find(':'), type.size());
  std::string out = value_word(type.substr(0, end));
  while (end < type.size()) {
    const std::size_t begin = end + 1;
    end = std::min(type.find(':', begin), type.size());
    const std::string part = type.substr(begin, end - begin);
    if (const std::string choices = choice_words(part, "|"); !choices.empty())
      out = choices;
    else
      out += " " + range_words(part);
  }
  return out;
}

}  // namespace karst::tools
