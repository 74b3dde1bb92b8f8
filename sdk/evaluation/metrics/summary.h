// A flight, or that of a team, summed up in one sentence for people.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "sdk/evaluation/metrics/ending.h"

namespace karst::evaluation {

/// "nearest_frontier explored 506 m³ of small (38.7 % of what can be reached) in 40 s, 0.38 m or more from
/// rock": what metrics.json knows of it. Names whoever explored: after a failure of the policy the fallback.
std::string achievement_of(const nlohmann::ordered_json& metrics, const Ending& ending);

/// The same and the ending.
std::string summary_of(const nlohmann::ordered_json& metrics, const Ending& ending);

}  // namespace karst::evaluation
