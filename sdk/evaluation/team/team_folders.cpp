#include "sdk/evaluation/team/team_folders.h"

#include <fstream>
#include <optional>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/json_text.h"
#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kMaxRobots = 1000;  // above this a number is damaged

struct TeamSize {
  int robots = 0;
  std::string said_by;
};

std::optional<TeamSize> reported_size(std::optional<double> robots, const fs::path& file) {
  if (!robots || !(*robots >= 1 && *robots <= kMaxRobots)) return std::nullopt;
  return TeamSize{static_cast<int>(*robots), file.filename().string()};
}

std::optional<TeamSize> size_in_log(const fs::path& log) {
  if (!fs::is_regular_file(log)) return std::nullopt;
  std::ifstream in = core::open_input(log, core::kMaxRecordFileBytes);
  std::string line;
  std::getline(in, line);
  const json first = core::json_of(line);
  if (!first.is_object() || event_text(first, "kind") != "team") return std::nullopt;
  return reported_size(event_number(first, "robots"), log);
}

std::optional<TeamSize> size_in_mission(const fs::path& mission) {
  std::vector<std::string> no_matter;
  RunRecord settings;
  settings.settings = read_settings(mission, no_matter);
  return reported_size(settings.number("team.robots"), mission);
}

fs::path folder(const fs::path& run_dir, int robot) { return run_dir / ("robot_" + std::to_string(robot)); }

}  // namespace

bool is_team(const fs::path& run_dir) {
  if (fs::exists(run_dir / "team.jsonl") || fs::exists(folder(run_dir, 1))) return true;
  const auto size = size_in_mission(run_dir / "mission.info");
  return size && size->robots > 1;
}

std::vector<fs::path> robot_folders(const fs::path& run_dir) {
  if (!fs::is_directory(run_dir)) throw core::InputError(run_dir.string(), "", "no such run directory");
  const fs::path log = run_dir / "team.jsonl";
  if (!fs::is_regular_file(log))
    throw core::InputError(log.string(), "", "not there: without it a team's run cannot be evaluated");
  auto size = size_in_log(log);
  if (!size) size = size_in_mission(run_dir / "mission.info");
  std::vector<fs::path> folders;
  for (int i = 1; size ? i <= size->robots : fs::is_directory(folder(run_dir, i)); ++i) {
    folders.push_back(folder(run_dir, i));
    if (!fs::is_directory(folders.back()))
      throw core::InputError(folders.back().string(), "",
                             "not there, though " + size->said_by + " says that the team had " +
                                 std::to_string(size->robots) + " robots");
  }
  if (folders.empty())
    throw core::InputError(folder(run_dir, 1).string(), "", "not there: the team has no robots");
  return folders;
}

}  // namespace karst::evaluation
