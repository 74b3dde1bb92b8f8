#include "sdk/survey/therion_files.h"

#include <algorithm>
#include <system_error>

#include "core_stack/common/input_file.h"
#include "core_stack/common/printable.h"
#include "sdk/survey/input_path.h"
#include "sdk/survey/text_encoding.h"

namespace karst::survey {
namespace {

bool is_space(char c) { return static_cast<unsigned char>(c) < 33; }

/// A quoted word that begins after the quote at `at`; `at` is then behind the closing one.
std::string quoted_word(std::string_view line, std::size_t& at) {
  std::string word;
  for (; at < line.size(); ++at) {
    if (line[at] == '"') {
      if (at + 1 == line.size() || line[at + 1] != '"') break;
      ++at;
    }
    word += line[at];
  }
  ++at;
  return word;
}

std::string bracketed_word(std::string_view line, std::size_t& at) {
  const std::size_t begin = at;
  std::size_t depth = 1;
  for (; at < line.size(); ++at) {
    if (line[at] == '[') ++depth;
    if (line[at] == ']' && --depth == 0) break;
  }
  const std::string_view word = line.substr(begin, at - begin);
  ++at;
  return std::string(word);
}

}  // namespace

void split_words(std::string_view line, std::vector<std::string>& words) {
  words.clear();
  for (std::size_t at = 0; at < line.size();) {
    if (is_space(line[at])) {
      ++at;
    } else if (line[at] == '#') {
      return;
    } else if (line[at] == '"') {
      words.push_back(quoted_word(line, ++at));
    } else if (line[at] == '[') {
      words.push_back(bracketed_word(line, ++at));
    } else {
      const std::size_t begin = at;
      while (at < line.size() && !is_space(line[at])) ++at;
      words.emplace_back(line.substr(begin, at - begin));
    }
  }
}

TherionFiles::TherionFiles(const std::string& root, SourceLog& log) : log_(log) {
  open_.reserve(kMaxInputDepth + 1);
  open(root);
}

void TherionFiles::open(const std::string& path) {
  Open file;
  file.path = path;
  file.text = core::read_input(path, kMaxSurveyBytes);
  bytes_ += file.text.size();
  const auto known = std::find(log_.files.begin(), log_.files.end(), path);
  file.next.file = static_cast<std::uint32_t>(known - log_.files.begin());
  if (known == log_.files.end()) log_.files.push_back(path);
  open_.push_back(std::move(file));
}

void TherionFiles::input(const std::string& name) {
  if (++inputs_ > kMaxInputs)
    throw log_.error(source_, "more than " + std::to_string(kMaxInputs) + " inputs are not read");
  const InputPath found = input_path(open_.back().path.parent_path(), name);
  if (found.path.extension() == ".th2" || std::filesystem::path(name).extension() == ".th2") {
    log_.note(source_, "drawings (.th2) are not read");
    return;
  }
  if (found.path.empty()) throw log_.error(source_, "cannot find the input " + name);
  if (found.other_case)
    log_.note(source_, "no input is called " + name + "; read instead: " + found.path.string());
  std::error_code none;
  for (const Open& o : open_)
    if (std::filesystem::equivalent(o.path, found.path, none))
      throw log_.error(source_, "inputs " + name + ", which this line itself is part of");
  if (open_.size() >= kMaxInputDepth)
    throw log_.error(source_,
                     "files that input each other are read " + std::to_string(kMaxInputDepth) + " deep");
  open(found.path.string());
  if (bytes_ > kMaxSurveyBytes)
    throw log_.error(source_, "the survey is longer than " + std::to_string(kMaxSurveyBytes) + " bytes");
}

bool TherionFiles::next_line() {
  line_.clear();
  std::string bytes;
  while (!open_.empty()) {
    Open& file = open_.back();
    if (file.at >= file.text.size()) {
      open_.pop_back();
      continue;
    }
    source_ = {file.next.file, file.next.line + 1};
    for (bool more = true; more && file.at < file.text.size();) {
      const std::size_t end = std::min(file.text.find('\n', file.at), file.text.size());
      std::string_view part(file.text.data() + file.at, end - file.at);
      file.at = end + 1;
      ++file.next.line;
      while (!part.empty() && is_space(part.back())) part.remove_suffix(1);
      more = part.ends_with('\\');
      if (more) part.remove_suffix(1);
      if (bytes.size() + part.size() > kMaxLineBytes)
        throw log_.error(source_, "the line is longer than " + std::to_string(kMaxLineBytes) + " bytes");
      bytes += part;
    }
    Decoded decoded = to_utf8(bytes, file.encoding);
    if (decoded.replaced && !file.replaced) {
      file.replaced = true;
      log_.note(source_, "is not " + file.encoding +
                             ": here and below, bytes that stand for no character are read as '?'");
    }
    line_ = std::move(decoded.text);
    return true;
  }
  return false;
}

bool TherionFiles::is_command_of_files() {
  const std::string& command = words_.front();
  if (command != "input" && command != "encoding" && command != "require") return false;
  if (words_.size() != 2) throw log_.error(source_, command + " takes one word");
  if (command == "input") input(words_[1]);
  if (command == "encoding") {
    const auto encoding = known_encoding(words_[1]);
    if (!encoding) throw log_.error(source_, "the encoding " + core::printable(words_[1]) + " is not known");
    open_.back().encoding = *encoding;
  }
  return true;
}

bool TherionFiles::next() {
  while (next_line()) {
    split_words(line_, words_);
    if (!words_.empty() && !is_command_of_files()) return true;
  }
  return false;
}

}  // namespace karst::survey
