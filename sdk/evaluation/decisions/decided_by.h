// Who made a decision and what came of it, in words. The recorded ones name the fallback alike where it
// stepped in for a policy that failed, and where it only looked for what the policy's refused goals left.
#pragma once
#include <string>

#include "sdk/evaluation/decisions/decision_record.h"

namespace karst::evaluation {

/// "mine"; "the fallback, because all goals of mine were refused"; "" if it is not recorded.
std::string decided_by(const DecisionRecord& decision);

/// "explored, all walls seen"; "nothing within reach in the time left".
std::string outcome_words(const DecisionRecord& decision);

}  // namespace karst::evaluation
