#include "core_stack/common/info_lines.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string_view>

#include "core_stack/common/error.h"

namespace karst::core {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepestInclude = 20, kDeepestBlock = 100;
constexpr const char* kSpace = " \t\r\v\f";

void append_file(const std::string& file, int depth, std::vector<InfoLine>& lines);

/// `rest` is what follows the #.
void append_directive(const InfoLine& line, const std::string& rest, int depth,
                      std::vector<InfoLine>& lines) {
  std::istringstream words(rest);
  std::string word, name;
  char quote = 0;
  if (!(words >> word >> quote) || word != "include" || quote != '"' ||
      !(words.unget() >> std::quoted(name)) || words >> word)
    throw InputError(line.file, line.place(), "expected #include \"file\"");
  if (depth == kDeepestInclude)
    throw InputError(line.file, line.place(), "files include each other too deeply");
  const fs::path part = fs::path(line.file).parent_path() / name;
  if (std::error_code ignored; !fs::exists(part, ignored))
    throw InputError(line.file, line.place(), "includes \"" + part.string() + "\", which is not there");
  append_file(part.string(), depth + 1, lines);
}

void append_file(const std::string& file, int depth, std::vector<InfoLine>& lines) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) throw InputError(file, "", "is a directory, not a file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file, "", "cannot open file");
  InfoLine line{"", file, 0};
  while (std::getline(in, line.text)) {
    if (++line.number == 1 && line.text.starts_with("\xEF\xBB\xBF"))
      throw InputError(file, "line 1", "begins with a UTF-8 byte order mark; save it without one");
    const auto first = line.text.find_first_not_of(kSpace);
    if (first != std::string::npos && line.text[first] == '#')
      append_directive(line, line.text.substr(first + 1), depth, lines);
    else
      lines.push_back(line);
  }
  if (in.bad()) throw InputError(file, "", "cannot be read");
}

/// The change of depth along a line: braces that are words of their own, outside of quotes and comments.
void follow(std::string_view text, int& depth, int& deepest) {
  text = text.substr(0, text.find('\0'));  // where Boost's reader ends a line
  for (std::size_t at = 0; (at = text.find_first_not_of(kSpace, at)) < text.size() && text[at] != ';';) {
    if (text[at] == '{' || text[at] == '}') {
      deepest = std::max(deepest, depth += text[at++] == '{' ? 1 : -1);
    } else if (text[at] == '"') {
      for (++at; at < text.size() && text[at] != '"'; ++at) at += text[at] == '\\';
      ++at;
    } else {
      at = text.find_first_of(" \t\r\v\f;", at);
    }
  }
}

}  // namespace

std::vector<InfoLine> info_lines(const std::string& file) {
  std::vector<InfoLine> lines;
  append_file(file, 0, lines);
  return lines;
}

void check_depth(const std::vector<InfoLine>& lines) {
  int depth = 0, deepest = 0;
  for (const InfoLine& line : lines) {
    follow(line.text, depth, deepest);
    if (deepest > kDeepestBlock)
      throw InputError(line.file, line.place(),
                       "blocks stand more than " + std::to_string(kDeepestBlock) + " deep in each other");
  }
}

std::string beside(const std::string& file, const std::string& path) {
  if (path.empty() || std::filesystem::path(path).is_absolute()) return path;
  return (std::filesystem::path(file).parent_path() / path).lexically_normal().string();
}

}  // namespace karst::core
