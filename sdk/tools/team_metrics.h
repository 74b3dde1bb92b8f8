// The figures of a team's run, as its metrics.json holds them. Definitions: docs/metrics.md.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core_stack/mission/team_mission.h"
#include "sdk/tools/mission_file.h"

namespace karst::tools {

/// `robots` are the metrics of each robot's own run. Figures of one flight are null but for sums over the
/// robots; a robot's own are below `robots`.
nlohmann::ordered_json team_metrics(const Mission& mission, const core::TeamResult& result,
                                    const std::vector<nlohmann::json>& robots);

/// timing.json of the team.
void write_team_timing(const std::filesystem::path& run_dir, double simulated_s, double wall_s, int threads);

}  // namespace karst::tools
