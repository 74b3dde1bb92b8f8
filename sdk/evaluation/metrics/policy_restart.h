// A policy whose process broke in flight and was started once more (docs/isolation.md), out of the record.
#pragma once
#include <optional>
#include <string>

#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

struct PolicyRestart {
  std::string policy;
  double time_s = 0;   // of the call in which it broke; where that is not recorded, of the next decision
  std::string what;    // "crashed", "ended its process", or "broke"
  std::string detail;  // " in decide(), request 5 (SIGSEGV)"
};

/// There is at most one in a flight: the second time the policy fails.
std::optional<PolicyRestart> policy_restart(const RunRecord& run);

/// "half_visits crashed at 8.4 s in decide(), request 5 (SIGSEGV), and was started once more".
std::string sentence_of(const PolicyRestart& restart);

}  // namespace karst::evaluation
