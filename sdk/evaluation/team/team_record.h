// A team's run directory read back: every robot's record in the team's time, the base's knowledge, and all
// robots merged into one record. Each robot's record lists its own missing or damaged parts in `problems`.
#pragma once
#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

struct TeamRecord {
  std::filesystem::path directory;
  std::vector<nlohmann::json> events;  // team.jsonl: each an object with "t" and "kind"
  std::vector<RunRecord> robots;       // robot 1 first; all their times are the team's
  std::vector<double> starts_s;        // when each was switched on
  /// Settings, all poses, the union of the maps' growth, and a telemetry of t_s and explored_m3
  /// (team_volume_curve). Flies from the first take-off until the last robot's limit.
  RunRecord merged;
  std::optional<core::VoxelMap> map;  // the merged final maps (log-odds added); none if any robot has none
  double duration_s = 0;
  std::vector<Setting> settings;  // the team's mission.info
  nlohmann::json timing;          // the team's; null if absent
  std::vector<std::string> problems;
};

/// Throws InputError if `run_dir` is no directory, or lacks team.jsonl or a robot's folder.
TeamRecord read_team(const std::filesystem::path& run_dir);

}  // namespace karst::evaluation
