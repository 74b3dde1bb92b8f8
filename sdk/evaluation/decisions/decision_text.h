// A decision in words, for `karst explain`.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "sdk/evaluation/decisions/decision_record.h"

namespace karst::evaluation {

/// An answer of the policy as the host records it (sdk/host/serialization/request_log.h).
struct RecordedAnswer {
  std::uint32_t request = 0;  // its number: 1, 2, ...
  double stamp_s = 0;         // when it was made
  std::string answer;         // JSON
};

/// Several lines: the decision, its goals that have events, what became of the goal flown to, and the
/// frontiers offered.
std::string decision_text(const DecisionRecord& decision);

/// Several lines: the whole ranked list of an answer, with what became of each goal in this decision. An
/// answer of another shape is shown as it stands.
std::string answer_table(const RecordedAnswer& answer, const DecisionRecord& decision);

}  // namespace karst::evaluation
