#include "core_stack/common/info_lines.h"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <sstream>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"

namespace karst::core {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxIncludeDepth = 20, kMaxBlockDepth = 100;
constexpr const char* kSpace = " \t\r\v\f";

/// Collects the lines of a file and of those it includes.
class LineCollector {
 public:
  explicit LineCollector(Includes includes) : includes_(includes) {}

  void add_text(std::istream& in, const std::string& source, int depth = 0) {
    InfoLine line{"", source, 0};
    while (std::getline(in, line.text)) {
      ++line.number;
      check(line);
      const auto first = line.text.find_first_not_of(kSpace);
      if (first != std::string::npos && line.text[first] == '#')
        add_directive(line, line.text.substr(first + 1), depth);
      else
        lines_.push_back(line);
    }
    if (in.bad()) throw InputError(source, "", "cannot be read");
  }
  void add_file(const std::string& file, int depth = 0) {
    std::ifstream in = open_input(file, kMaxInfoBytes);
    add_text(in, file, depth);
  }
  std::vector<InfoLine> take() { return std::move(lines_); }

 private:
  void check(const InfoLine& line) {
    if (line.number == 1 && line.text.starts_with("\xEF\xBB\xBF"))
      throw InputError(line.file, "line 1", "begins with a UTF-8 byte order mark; save it without one");
    if (line.text.find('\0') != std::string::npos)
      throw InputError(line.file, line.place(), "holds a zero byte: this is no text");
    if ((bytes_ += line.text.size() + 1) > kMaxInfoBytes + 1)
      throw InputError(line.file, line.place(),
                       "more than " + std::to_string(kMaxInfoBytes) + " bytes are not read");
  }

  /// `rest` is what follows the #.
  void add_directive(const InfoLine& line, const std::string& rest, int depth) {
    if (includes_ == Includes::refuse)
      throw InputError(line.file, line.place(), "#include is followed in mission files only");
    std::istringstream words(rest);
    std::string word, name;
    char quote = 0;
    if (!(words >> word >> quote) || word != "include" || quote != '"' ||
        !(words.unget() >> std::quoted(name)) || words >> word)
      throw InputError(line.file, line.place(), "expected #include \"file\"");
    if (depth == kMaxIncludeDepth)
      throw InputError(line.file, line.place(), "files include each other too deeply");
    const fs::path part = fs::path(line.file).parent_path() / name;
    if (std::error_code ignored; !fs::exists(part, ignored))
      throw InputError(line.file, line.place(), "includes \"" + part.string() + "\", which is not there");
    add_file(part.string(), depth + 1);
  }

  Includes includes_;
  std::size_t bytes_ = 0;
  std::vector<InfoLine> lines_;
};

/// What is counted from line to line.
class InfoBounds {
 public:
  void add(const InfoLine& line) {
    follow(line.text);
    line_bytes_ += line.text.size();
    if (words_ > kMaxInfoWords)
      throw InputError(line.file, line.place(),
                       "more than " + std::to_string(kMaxInfoWords) + " keys and values are not read");
    if (line_bytes_ > kMaxInfoLineBytes)
      throw InputError(line.file, line.place(),
                       "more than " + std::to_string(kMaxInfoLineBytes) + " bytes in a line are not read");
    if (deepest_ > kMaxBlockDepth)
      throw InputError(line.file, line.place(),
                       "blocks stand more than " + std::to_string(kMaxBlockDepth) + " deep in each other");
    if (!continued_) line_bytes_ = 0;
  }

 private:
  /// Along a line: braces that are words of their own, outside of quotes and comments, change the depth.
  /// After a backslash a text in quotes goes on in the next line that has words.
  void follow(std::string_view text) {
    const std::size_t words_before = words_;
    bool backslash = false;
    for (std::size_t at = 0; (at = text.find_first_not_of(kSpace, at)) < text.size() && text[at] != ';';) {
      ++words_;
      if (text[at] == '{' || text[at] == '}') {
        deepest_ = std::max(deepest_, depth_ += text[at++] == '{' ? 1 : -1);
      } else if (text[at] == '"') {
        for (++at; at < text.size() && text[at] != '"'; ++at) at += text[at] == '\\';
        ++at;
      } else {
        backslash |= text[at] == '\\';
        at = text.find_first_of(" \t\r\v\f;", at);
      }
    }
    if (words_ > words_before) continued_ = backslash;
  }

  std::size_t words_ = 0, line_bytes_ = 0;
  int depth_ = 0, deepest_ = 0;
  bool continued_ = false;
};

}  // namespace

std::vector<InfoLine> info_lines(const std::string& file, Includes includes) {
  LineCollector lines(includes);
  lines.add_file(file);
  return lines.take();
}

std::vector<InfoLine> info_lines_of(std::string_view text, const std::string& source) {
  if (text.size() > kMaxInfoBytes)
    throw InputError(source, "",
                     "is " + std::to_string(text.size()) + " bytes long; more than " +
                         std::to_string(kMaxInfoBytes) + " are not read");
  LineCollector lines(Includes::refuse);
  std::istringstream in{std::string(text)};
  lines.add_text(in, source);
  return lines.take();
}

void check_bounds(const std::vector<InfoLine>& lines) {
  InfoBounds bounds;
  for (const InfoLine& line : lines) bounds.add(line);
}

std::string beside(const std::string& file, const std::string& path) {
  if (path.empty() || fs::path(path).is_absolute()) return path;
  return (fs::path(file).parent_path() / path).lexically_normal().string();
}

}  // namespace karst::core
