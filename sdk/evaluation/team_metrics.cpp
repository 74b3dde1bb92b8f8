#include "sdk/evaluation/team_metrics.h"

#include "core_stack/common/error.h"
#include "core_stack/mapping/octomap_io.h"

namespace karst::evaluation {
namespace {

namespace fs = std::filesystem;

/// Nothing if any robot has none: half a team's map would pass for the whole.
std::optional<core::VoxelMap> merged_map(const TeamRecord& team, std::vector<std::string>& problems) {
  std::optional<core::VoxelMap> all;
  for (const RunRecord& robot : team.robots) {
    const fs::path file = robot.directory / "map.bt";
    try {
      if (!fs::is_regular_file(file)) throw core::InputError(file.string(), "", "not there");
      core::VoxelMap map = core::read_octomap(file.string());
      if (!all) {
        all = std::move(map);
        continue;
      }
      if (all->resolution_m() != map.resolution_m())
        throw core::InputError(file.string(), "", "has cells of another size than robot 1's map");
      map.for_each_known([&](const core::CellKey& k, core::Cell, float log_odds) {
        all->assign(k, 1, all->log_odds(k).value_or(0.0f) + log_odds);
      });
    } catch (const std::exception& e) {
      problems.push_back(std::string(e.what()) + "; the team's volume is estimated from the telemetry");
      return std::nullopt;
    }
  }
  return all;
}

}  // namespace

nlohmann::ordered_json team_map_figures(const TeamRecord& team, const Truth& truth,
                                        std::vector<std::string>& problems) {
  const auto map = merged_map(team, problems);
  const nlohmann::ordered_json all = evaluate(team.merged, map ? &*map : nullptr, truth);
  nlohmann::ordered_json out;
  for (const char* key :
       {"explored_volume_m3", "reachable_volume_m3", "coverage", "horizon_s", "coverage_auc",
        "coverage_at_25", "coverage_at_50", "coverage_at_75", "t50_s", "t90_s", "t95_s", "restricted_t50_s",
        "restricted_t90_s", "restricted_t95_s", "surface_seen", "map_error_mean_m", "map_error_std_m"})
    out[key] = all[key];
  return out;
}

}  // namespace karst::evaluation
