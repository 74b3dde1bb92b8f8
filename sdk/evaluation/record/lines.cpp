#include "sdk/evaluation/record/lines.h"

#include <charconv>
#include <limits>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"

namespace karst::evaluation {

std::vector<std::string> read_lines(const std::filesystem::path& file, std::vector<std::string>& problems) {
  std::vector<std::string> lines;
  std::error_code absent;
  if (!std::filesystem::exists(file, absent)) return lines;
  const std::string name = file.filename().string();
  std::string bytes;
  try {
    bytes = core::read_input(file, core::kMaxRecordFileBytes);
  } catch (const core::InputError& e) {
    problems.push_back(e.what());
    return lines;
  }
  if (bytes.empty()) problems.push_back(name + ": is empty: its content is lost or was never written");
  std::size_t begin = 0;
  for (std::size_t end; (end = bytes.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const bool carriage_return = end > begin && bytes[end - 1] == '\r';
    lines.push_back(bytes.substr(begin, end - begin - (carriage_return ? 1 : 0)));
  }
  if (begin < bytes.size())
    problems.push_back(name + ": line " + std::to_string(lines.size() + 1) +
                       ": cut off; only the lines before it are used");
  return lines;
}

void BadLines::add(std::size_t line, const std::string& reason) {
  if (count_++ == 0) first_ = "line " + std::to_string(line) + ": " + reason;
}

void BadLines::report(std::vector<std::string>& problems) const {
  if (count_ == 0) return;
  std::string text = file_ + ": " + first_;
  if (count_ > 1) text += " (and " + std::to_string(count_ - 1) + " more such lines)";
  problems.push_back(text + "; left out");
}

bool parse_number(const std::string& text, double& value) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos || text == "nan" || text == "-nan") {
    value = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  const auto last = text.find_last_not_of(" \t") + 1;
  const auto [end, error] = std::from_chars(text.data() + first, text.data() + last, value);
  return error == std::errc() && end == text.data() + last;
}

}  // namespace karst::evaluation
