// What a team's merged map says. Definitions: docs/metrics.md
#pragma once
#include "sdk/evaluation/metrics.h"
#include "sdk/evaluation/team_record.h"

namespace karst::evaluation {

/// Volume, coverage and its times, surface and error of the map that the robots' final maps make together
/// (log-odds added, all in the world's frame), as evaluate() has them of one. What is missing stands in
/// `problems`; a robot without a final map counts with what its telemetry and growth say.
nlohmann::ordered_json team_map_figures(const TeamRecord& team, const Truth& truth,
                                        std::vector<std::string>& problems);

}  // namespace karst::evaluation
