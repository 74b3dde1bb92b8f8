#include "sdk/evaluation/team/team_record.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "sdk/evaluation/metrics/coverage_curve.h"
#include "sdk/evaluation/metrics/flight_figures.h"
#include "sdk/evaluation/team/team_folders.h"
#include "sdk/evaluation/team/team_volume.h"

namespace karst::evaluation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Shifts all times of a record by `s`.
void delay(RunRecord& run, double s) {
  const auto ms = std::llround(1000 * s);
  const auto later = [ms](std::int32_t& t_ms) {  // saturates if a damaged time would overflow
    t_ms = static_cast<std::int32_t>(std::clamp<long long>(t_ms + ms, INT32_MIN, OccupiedSpan::kNever - 1));
  };
  for (json& e : run.events) e["t"] = e["t"].get<double>() + s;
  for (auto* poses : {&run.estimate, &run.truth})
    for (StampedPose& p : *poses) p.t_s += s;
  for (OccupiedSpan& o : run.growth) {
    later(o.from_ms);
    if (o.until_ms != OccupiedSpan::kNever) later(o.until_ms);
  }
  for (Table* table : {&run.telemetry, &run.truth_table, &run.decisions})
    for (const char* key : {"t_s", "time_s"})
      if (const auto column = table->numbers.find(key); column != table->numbers.end())
        for (double& t : column->second) t += s;
  for (Phase& p : run.phases) {
    p.begin_s += s;
    p.end_s += s;
  }
}

double start_of(const std::vector<json>& events, std::size_t robot, std::vector<std::string>& problems) {
  for (const json& e : events)
    if (e["kind"] == "start" && event_number(e, "robot") == static_cast<double>(robot)) return e["t"];
  problems.push_back("team.jsonl: does not say when robot " + std::to_string(robot) +
                     " started; it is shown as if at 0 s");
  return 0;
}

/// A cell is occupied while it is so in any robot's map.
std::vector<OccupiedSpan> united(const std::vector<RunRecord>& robots) {
  std::vector<OccupiedSpan> all, out;
  for (const RunRecord& r : robots) all.insert(all.end(), r.growth.begin(), r.growth.end());
  std::sort(all.begin(), all.end(), [](const OccupiedSpan& a, const OccupiedSpan& b) {
    return a.key != b.key ? a.key < b.key : a.from_ms < b.from_ms;
  });
  for (const OccupiedSpan& s : all) {
    const bool touches = !out.empty() && out.back().key == s.key && s.from_ms <= out.back().until_ms;
    if (touches)
      out.back().until_ms = std::max(out.back().until_ms, s.until_ms);
    else
      out.push_back(s);
  }
  return out;
}

std::vector<StampedPose> in_order(const std::vector<RunRecord>& robots,
                                  std::vector<StampedPose> RunRecord::*poses) {
  std::vector<StampedPose> all;
  for (const RunRecord& r : robots) all.insert(all.end(), (r.*poses).begin(), (r.*poses).end());
  std::stable_sort(all.begin(), all.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.t_s < b.t_s; });
  return all;
}

/// The longest possible flight of the team: until the last robot's start, plus one robot's limit.
void set_horizon(RunRecord& merged, double last_start_s) {
  const auto own = horizon_s(merged);
  if (!own) return;
  std::erase_if(merged.settings, [](const Setting& s) {
    return s.key == "mission.max_flight_time" || s.key == "simulator.battery_minutes";
  });
  merged.settings.push_back({"mission.max_flight_time", std::to_string(*own + last_start_s) + " s"});
}

/// None if any robot has none: half a team's map would be mistaken for the whole.
std::optional<core::VoxelMap> merged_map(TeamRecord& team) {
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
      team.problems.push_back(std::string(e.what()) + "; the team's volume is estimated from the telemetry");
      return std::nullopt;
    }
  }
  return all;
}

RunRecord merged_record(const TeamRecord& team) {
  RunRecord all;
  all.directory = team.directory;
  all.settings = team.robots.front().settings;
  all.estimate = in_order(team.robots, &RunRecord::estimate);
  all.truth = in_order(team.robots, &RunRecord::truth);
  all.growth = united(team.robots);
  double begin_s = team.duration_s;
  for (const RunRecord& r : team.robots) begin_s = std::min(begin_s, flight_begin_s(r));
  all.phases = {{core::name_of(core::Phase::standby), 0, begin_s}, {"flying", begin_s, team.duration_s}};
  set_horizon(all, *std::max_element(team.starts_s.begin(), team.starts_s.end()));
  const VolumeCurve curve = team_volume_curve(
      team.robots, all.growth, team.map ? std::optional(team.map->free_volume_m3()) : std::nullopt);
  all.telemetry.rows = curve.t_s.size();
  all.telemetry.numbers = {{"t_s", curve.t_s}, {"explored_m3", curve.explored_m3}};
  return all;
}

}  // namespace

TeamRecord read_team(const fs::path& run_dir) {
  const std::vector<fs::path> folders = robot_folders(run_dir);
  TeamRecord team;
  team.directory = run_dir;
  team.events = read_events(run_dir / "team.jsonl", "t", "kind", team.problems);
  for (std::size_t i = 0; i < folders.size(); ++i) {
    RunRecord robot = read_run(folders[i]);
    team.starts_s.push_back(start_of(team.events, i + 1, team.problems));
    delay(robot, team.starts_s.back());
    team.duration_s = std::max(team.duration_s, robot.last_time_s());
    team.robots.push_back(std::move(robot));
  }
  team.settings = read_settings(run_dir / "mission.info", team.problems);
  team.timing = read_json(run_dir / "timing.json", team.problems);
  for (const json& e : team.events) team.duration_s = std::max(team.duration_s, e["t"].get<double>());
  team.map = merged_map(team);
  team.merged = merged_record(team);
  return team;
}

}  // namespace karst::evaluation
