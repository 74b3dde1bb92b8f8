// The folders of a team's run.
#pragma once
#include <filesystem>
#include <vector>

namespace karst::evaluation {

/// Whether `run_dir` is that of a team, by any of these traces: team.jsonl, robot_1/, several robots in
/// mission.info.
bool is_team(const std::filesystem::path& run_dir);

/// robot_1/, robot_2/, ...: as many as the first line of team.jsonl says, or else mission.info; if neither
/// does, as many as exist. Throws InputError with the missing item: `run_dir`, its team.jsonl, or a robot's
/// folder.
std::vector<std::filesystem::path> robot_folders(const std::filesystem::path& run_dir);

}  // namespace karst::evaluation
