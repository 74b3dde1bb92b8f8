#include "sdk/host/boundary/policy_output.h"

#include <algorithm>

#include "core_stack/common/printable.h"

namespace karst::host {
namespace {

constexpr std::size_t kLongestLine_bytes = 4096;  // longer ones are broken
constexpr std::size_t kLastLines = 10, kLastLine_bytes = 200;

constexpr const char* kCut = "[karst: the rest is left out: of a policy's output a flight keeps 1 MiB]\n";

}  // namespace

void PolicyOutput::add(std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  while (!bytes.empty()) {
    const std::size_t end = bytes.find('\n'),
                      taken = std::min({bytes.size(), end, kLongestLine_bytes - line_.size()});
    const bool ended = taken == end;
    line_ += bytes.substr(0, taken);
    bytes.remove_prefix(ended ? taken + 1 : taken);
    if (ended || line_.size() == kLongestLine_bytes) keep_line();
  }
  if (file_.is_open()) file_.flush();
}

void PolicyOutput::end_line() {
  const std::lock_guard lock(mutex_);
  if (!line_.empty()) keep_line();
  if (file_.is_open()) file_.flush();
}

void PolicyOutput::keep_line() {
  last_.push_back(line_.substr(0, kLastLine_bytes));
  if (last_.size() > kLastLines) last_.pop_front();
  if (!cut_) {
    const std::string text = core::printable(line_) + "\n";
    cut_ = kept_bytes_ + text.size() > kOutputBudget_bytes;
    kept_bytes_ += text.size();
    put(cut_ ? kCut : text);
  }
  line_.clear();
}

void PolicyOutput::put(const std::string& text) {
  if (file_name_.empty()) {
    unwritten_ += text;
    return;
  }
  if (!file_.is_open()) file_.open(file_name_, std::ios::binary | std::ios::trunc);
  file_ << text;
}

void PolicyOutput::write_to(const std::filesystem::path& file) {
  const std::lock_guard lock(mutex_);
  file_name_ = file;
  if (unwritten_.empty()) return;
  put(unwritten_);
  file_.flush();
  unwritten_.clear();
}

void PolicyOutput::note_break() {
  const std::lock_guard lock(mutex_);
  before_break_ = last_lines_now();
}

bool PolicyOutput::empty() const {
  const std::lock_guard lock(mutex_);
  return kept_bytes_ == 0;
}

std::string PolicyOutput::last_lines_now() const {
  std::string text;
  for (const std::string& line : last_) text += core::printable(line) + "\n";
  return text;
}

std::string PolicyOutput::last_lines() const {
  const std::lock_guard lock(mutex_);
  return last_lines_now();
}

std::string PolicyOutput::before_break() const {
  const std::lock_guard lock(mutex_);
  return before_break_;
}

std::string PolicyOutput::problem() const {
  const std::lock_guard lock(mutex_);
  const bool wanted = !file_name_.empty() && kept_bytes_ > 0;
  return wanted && !file_ ? file_name_.string() + ": cannot be written" : "";
}

}  // namespace karst::host
