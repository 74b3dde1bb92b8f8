// The figures of a team's run, as its metrics.json holds them. Definitions: docs/metrics.md.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core_stack/mission/team_mission.h"
#include "sdk/tools/mission_file.h"

namespace karst::tools {

struct TeamFlight {
  std::string policy, cave;
  std::int64_t seed = 0;
  std::string outcome, reason;
};

/// Sets the sums over the robots that are null.
void add_sums(nlohmann::ordered_json& metrics, const std::vector<nlohmann::json>& robots);

/// What is known of any flight: sums over the `robots`, and null for all other figures.
nlohmann::ordered_json begin_team_metrics(const TeamFlight& flight,
                                          const std::vector<nlohmann::json>& robots);

/// `robots` are the metrics of each robot's own run. Figures of one flight are null but for sums over the
/// robots; a robot's own are below `robots`.
nlohmann::ordered_json team_metrics(const Mission& mission, const core::TeamResult& result,
                                    const std::vector<nlohmann::json>& robots);

/// timing.json of the team.
void write_team_timing(const std::filesystem::path& run_dir, double simulated_s, double wall_s, int threads);

}  // namespace karst::tools
