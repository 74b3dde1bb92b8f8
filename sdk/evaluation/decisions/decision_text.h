// A decision in words, for `karst explain`.
#pragma once
#include <string>

#include "sdk/evaluation/decisions/ranked_goals.h"

namespace karst::evaluation {

/// Several lines: the decision, its goals that have events, what became of the goal flown to, and the
/// frontiers offered.
std::string decision_text(const DecisionRecord& decision);

/// Several lines: the whole ranked list of an answer, with what became of each goal in this decision. An
/// answer of another shape is shown as it stands.
std::string answer_table(const RecordedAnswer& answer, const DecisionRecord& decision);

}  // namespace karst::evaluation
