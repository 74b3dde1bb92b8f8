// The complete lines of a text file that may end in mid-line, and reports about malformed ones.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace karst::evaluation {

/// Lines without their line ends. A last line without one was truncated: it is left out and reported.
/// A missing file has no lines; an unreadable one is reported.
std::vector<std::string> read_lines(const std::filesystem::path& file, std::vector<std::string>& problems);

/// Collects the malformed lines of one file and reports them in one sentence.
class BadLines {
 public:
  explicit BadLines(const std::filesystem::path& file) : file_(file.filename().string()) {}
  void add(std::size_t line, const std::string& reason);
  void report(std::vector<std::string>& problems) const;

 private:
  std::string file_, first_;
  std::size_t count_ = 0;
};

/// Parses a CSV cell: "" and "nan" are NaN. Returns false for text that is not a number.
bool parse_number(const std::string& text, double& value);

}  // namespace karst::evaluation
