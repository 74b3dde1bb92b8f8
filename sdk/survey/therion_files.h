// The lines of a Therion file and of all that it inputs, in the order in which Therion reads them.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sdk/survey/source_log.h"

namespace karst::survey {

constexpr std::size_t kMaxInputDepth = 64;             // files that input each other
constexpr std::size_t kMaxInputs = 100'000;            // of all files
constexpr std::size_t kMaxSurveyBytes = 1024u << 20u;  // of all files; one that is input twice counts twice
constexpr std::size_t kMaxLineBytes = 65'535;          // as in Therion, continuations included

/// Words, "quoted words" in which "" stands for one quote, and [words in brackets], up to the first '#'.
void split_words(std::string_view line, std::vector<std::string>& words);

/// Gives line after line: continuations (\) joined, text in UTF-8, `input` and `encoding` carried out.
/// Throws core::InputError with file and line: a file that cannot be read, one that inputs itself, a line
/// or a survey that is too long, an unknown encoding. Drawings (.th2) are not opened, which is noted.
class TherionFiles {
 public:
  TherionFiles(const std::string& root, SourceLog& log);

  /// The words of the next line that has any. False at the end.
  bool next();
  const std::vector<std::string>& words() const { return words_; }
  const std::string& line() const { return line_; }
  const Source& source() const { return source_; }

 private:
  struct Open {
    std::filesystem::path path;
    std::string text, encoding = "UTF-8";
    std::size_t at = 0;
    Source next;
    bool replaced = false;  // whether that was noted
  };
  void open(const std::string& path);
  void input(const std::string& name);
  bool next_line();
  bool is_command_of_files();

  SourceLog& log_;
  std::vector<Open> open_;
  std::vector<std::string> words_;
  std::string line_;
  Source source_;
  std::size_t inputs_ = 0, bytes_ = 0;
};

}  // namespace karst::survey
