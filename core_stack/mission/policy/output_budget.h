// Limits what a policy may draw and log in a flight, since all of it goes to disk and into the report.
#pragma once
#include <cstddef>

#include "core_stack/mission/policy/policy_port.h"

namespace karst::core {

struct OutputLimits {
  std::size_t drawn_points = 100'000;  // 6 MB in events.jsonl
  std::size_t drawings = 10'000;       // points, lines or texts: a few for each decision
  std::size_t log_bytes = std::size_t{1} << 20;
};

/// Counts output over a whole flight. Once a limit is reached, no more output of that kind is kept, and the
/// log says so once.
class OutputBudget {
 public:
  explicit OutputBudget(const OutputLimits& limits = {}) : left_(limits) {}

  /// Removes output beyond the limits from the decision.
  void trim(Decision& decision);

 private:
  void trim_drawings(Decision& decision);
  void trim_log(Decision& decision);

  OutputLimits left_;
  bool drawings_spent_ = false, log_spent_ = false;
};

}  // namespace karst::core
