// The goals pursued by the vehicle, each with its time span and its fate.
#pragma once
#include <nlohmann/json.hpp>

#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

/// The fate of a goal that was accepted again at the same place, with another path: the next span goes on.
constexpr const char* kPlannedAnew = "planned anew";

/// Accepted goals in order of acceptance: t, until (null if the record ends before), position, heading,
/// score, why, fate, fate_reason. Two may be open at once: the current goal and the one appended to it; the
/// vehicle flies to the earlier one. Leaving the exploration phase ends all.
nlohmann::ordered_json goal_spans(const RunRecord& run);

}  // namespace karst::evaluation
