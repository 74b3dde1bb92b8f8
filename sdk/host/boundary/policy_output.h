// What a policy's own process prints on stdout and stderr, for the policy's author: lines in a file, and the
// last ones at hand for when the process breaks.
#pragma once
#include <cstddef>
#include <deque>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <string_view>

namespace karst::host {

constexpr const char* kPolicyOutputName = "policy_output.txt";  // in a run directory
constexpr std::size_t kOutputBudget_bytes = 1u << 20;           // of a policy in a flight

/// Takes what is printed on one thread, and may be asked by others. Whatever is printed, it needs a bounded
/// amount of memory and of disk, and what it gives out is printable (core_stack/common/printable.h).
class PolicyOutput {
 public:
  /// Bytes as they come: lines, or parts of them. Lines beyond the budget are left out of the file, whose
  /// last line then says so.
  void add(std::string_view bytes);
  /// The process is gone: what it printed last is a line, ended or not.
  void end_line();
  /// The process broke: the last lines until now are those of `before_break`.
  void note_break();
  /// Lines go into `file` from here on, those of before first. It is made with the first line.
  void write_to(const std::filesystem::path& file);

  /// Whether nothing was printed.
  bool empty() const;
  /// The last few lines, each shortened and with its newline.
  std::string last_lines() const;
  /// Those before the process last broke; "" if it did not break, or had printed nothing.
  std::string before_break() const;
  /// Why the file lacks lines within the budget; "" if it does not.
  std::string problem() const;

 private:
  void keep_line();
  void put(const std::string& text);
  std::string last_lines_now() const;

  mutable std::mutex mutex_;
  std::string line_;              // not ended yet
  std::deque<std::string> last_;  // lines as printed, shortened
  std::string before_break_;
  std::string unwritten_;  // until there is a file
  std::size_t kept_bytes_ = 0;
  bool cut_ = false;
  std::filesystem::path file_name_;
  std::ofstream file_;
};

}  // namespace karst::host
