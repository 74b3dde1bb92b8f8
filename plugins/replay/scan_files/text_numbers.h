// Words and numbers of text files, with the line each stands in.
#pragma once
#include <charconv>
#include <string_view>

namespace karst::replay {

/// Splits text into lines without copying it.
class TextReader {
 public:
  explicit TextReader(std::string_view text, std::size_t line = 1) : text_(text), line_(line) {}

  /// The next line without its end; false at the end of the text.
  bool line(std::string_view& out) {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    out = text_.substr(at_, end - at_);
    if (!out.empty() && out.back() == '\r') out.remove_suffix(1);
    at_ = end + 1;
    ++line_;
    return true;
  }
  /// The number, from 1, of the line read last.
  std::size_t number() const { return line_ - 1; }
  /// Byte offset of the next line.
  std::size_t position() const { return std::min(at_, text_.size()); }

 private:
  std::string_view text_;
  std::size_t at_ = 0, line_;
};

/// The next word of a line, between blanks or commas; empty at its end.
inline std::string_view next_word(std::string_view& rest) {
  const auto begin = rest.find_first_not_of(" \t,;");
  if (begin == std::string_view::npos) return rest = {};
  const auto end = std::min(rest.find_first_of(" \t,;", begin), rest.size());
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

/// A number, "nan" and "inf" included; false if the word is something else.
inline bool to_number(std::string_view word, double& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace karst::replay
