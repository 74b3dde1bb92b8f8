#include "sdk/evaluation/team/run_ending.h"

#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/json_file.h"
#include "sdk/evaluation/team/team_folders.h"

namespace karst::evaluation {
namespace {

namespace fs = std::filesystem;

Ending of_vehicle(const fs::path& run_dir) {
  const auto metrics = core::json_of_file(run_dir / "metrics.json");
  EndFigures figures;
  if (metrics.is_object())
    figures = {event_number(metrics, "landing_error_m"), event_number(metrics, "battery_left")};
  RunRecord run = read_events_alone(run_dir);
  run.settings = read_settings(run_dir / "mission.info", run.problems);
  figures.home_reserve_s = run.number(kHomeReserveKey);
  return ending_of(run, figures);
}

}  // namespace

std::vector<Ending> read_endings(const fs::path& run_dir) {
  if (!is_team(run_dir)) return {of_vehicle(run_dir)};
  std::vector<Ending> robots;
  try {
    for (const fs::path& robot : robot_folders(run_dir)) robots.push_back(of_vehicle(robot));
  } catch (const core::InputError&) {  // not all are there
    return {Ending{}};
  }
  return robots;
}

}  // namespace karst::evaluation
