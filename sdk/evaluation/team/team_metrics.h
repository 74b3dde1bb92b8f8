// What a team's merged map says. Definitions: docs/metrics.md
#pragma once
#include "sdk/evaluation/metrics/metrics.h"
#include "sdk/evaluation/team/team_record.h"

namespace karst::evaluation {

/// Volume, coverage and its times, surface and error of the map that the robots' final maps make together
/// (TeamRecord::map), as evaluate() has them of one. Without it the volume is the telemetry's last.
nlohmann::ordered_json team_map_figures(const TeamRecord& team, const Truth& truth);

}  // namespace karst::evaluation
