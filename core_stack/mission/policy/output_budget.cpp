#include "core_stack/mission/policy/output_budget.h"

namespace karst::core {
namespace {

constexpr std::size_t kLineOverhead_bytes = 40;  // of an event in the file, around its text

}  // namespace

void OutputBudget::trim(Decision& decision) {
  const bool drew = drawings_spent_, logged = log_spent_;
  trim_drawings(decision);
  trim_log(decision);
  if (log_spent_ && !logged)
    decision.log.push_back(
        "warning: the policy has logged all that a flight may: its log is left out from here on");
  if (drawings_spent_ && !drew)
    decision.log.push_back(
        "warning: the policy has drawn all that a flight may: its drawings are left out from here on");
}

void OutputBudget::trim_drawings(Decision& decision) {
  std::size_t kept = 0;
  for (const Drawing& d : decision.drawings) {
    if (drawings_spent_ || left_.drawings == 0 || d.points.size() > left_.drawn_points) {
      drawings_spent_ = true;
      break;
    }
    left_.drawings -= 1;
    left_.drawn_points -= d.points.size();
    ++kept;
  }
  decision.drawings.resize(kept);
}

void OutputBudget::trim_log(Decision& decision) {
  std::size_t kept = 0;
  for (const std::string& line : decision.log) {
    const std::size_t bytes = line.size() + kLineOverhead_bytes;
    if (log_spent_ || bytes > left_.log_bytes) {
      log_spent_ = true;
      break;
    }
    left_.log_bytes -= bytes;
    ++kept;
  }
  decision.log.resize(kept);
}

}  // namespace karst::core
