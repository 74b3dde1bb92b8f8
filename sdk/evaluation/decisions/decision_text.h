// A decision in words, for `karst explain`.
#pragma once
#include <string>
#include <vector>

#include "sdk/evaluation/decisions/ranked_goals.h"

namespace karst::evaluation {

/// Several lines: the decision, its goals, what became of the goal flown to, and the frontiers offered. Each
/// goal stands there once, below the policy that proposed it: those of the answers (none: not recorded), and
/// those that only have events.
std::string decision_text(const DecisionRecord& decision, const std::vector<RecordedAnswer>& answers);

/// One line of a list of decisions: when, and the goal flown to with its reason, or why there was none.
std::string decision_line(const DecisionRecord& decision);

/// Several lines: the whole ranked list of an answer, with what became of each goal in this decision. An
/// answer of another shape is shown as it stands.
std::string answer_table(const RecordedAnswer& answer, const DecisionRecord& decision);

}  // namespace karst::evaluation
