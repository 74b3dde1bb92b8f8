// Figures of a team's merged map. Definitions: docs/metrics.md
#pragma once
#include "sdk/evaluation/metrics/metrics.h"
#include "sdk/evaluation/team/team_record.h"

namespace karst::evaluation {

/// Volume, coverage and its times, surface and error of the map merged from the robots' final maps
/// (TeamRecord::map), as in evaluate(). Without a merged map the volume is the telemetry's last.
nlohmann::ordered_json team_map_figures(const TeamRecord& team, const Truth& truth);

}  // namespace karst::evaluation
