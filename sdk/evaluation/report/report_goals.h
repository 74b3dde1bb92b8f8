// Which goal the vehicle was after, from when to when, and what became of it.
#pragma once
#include <nlohmann/json.hpp>

#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

/// Accepted goals in the order of acceptance: t, until (null if the record ends before), position, heading,
/// score, why, fate, fate_reason. Two may be open at once: the one flown to and the one appended to it; the
/// vehicle is after the earlier. Leaving the exploration ends all.
nlohmann::ordered_json goal_spans(const RunRecord& run);

}  // namespace karst::evaluation
