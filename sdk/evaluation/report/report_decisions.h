// What each decision had to choose from, for the page.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

/// One entry a decision: {t, recorded, answers: [{request, outcome, reason, goals, left_out}, ...]}; a
/// policy's failure has `failure` instead, an answer of another shape `text`. With requests.bin, `recorded`
/// is true and `goals` the whole ranked list, best first; without it, the goals that have events, in one
/// answer without a number. A goal: {position, frontier, score, max_speed, why, fate}. A damaged requests.bin
/// is reported in `problems`, and so are goals left out to keep the page small.
nlohmann::ordered_json decision_choices(const RunRecord& run, std::vector<std::string>& problems);

}  // namespace karst::evaluation
