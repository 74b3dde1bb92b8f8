// The complete lines of a text file that may have been cut off in mid-line, and complaints about bad ones.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace karst::evaluation {

/// Without the line ends. A last line without one was cut off: it is left out and reported.
/// An absent file has no lines; an unreadable one is reported.
std::vector<std::string> read_lines(const std::filesystem::path& file, std::vector<std::string>& problems);

/// Gathers the bad lines of one file and reports them in one sentence.
class BadLines {
 public:
  explicit BadLines(const std::filesystem::path& file) : file_(file.filename().string()) {}
  void add(std::size_t line, const std::string& reason);
  void report(std::vector<std::string>& problems) const;

 private:
  std::string file_, first_;
  std::size_t count_ = 0;
};

/// A number as in a CSV cell: "" and "nan" are NaN. False if the text is something else.
bool parse_number(const std::string& text, double& value);

}  // namespace karst::evaluation
