#include "sdk/flight/finish_run.h"

#include <boost/property_tree/info_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core_stack/common/error.h"
#include "core_stack/common/json_file.h"
#include "core_stack/common/options.h"
#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/mapping/region/region_keys.h"
#include "plugins/simulator/cave/cave.h"
#include "sdk/cave_drawing/report_drawings.h"
#include "sdk/evaluation/metrics/flight_figures.h"
#include "sdk/evaluation/metrics/metrics.h"
#include "sdk/evaluation/reachable/imaged_rock.h"
#include "sdk/evaluation/reachable/reachable_file.h"
#include "sdk/evaluation/reachable/reachable_in_region.h"
#include "sdk/evaluation/reachable/surface.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/evaluation/report/report.h"
#include "sdk/evaluation/report/team_report.h"
#include "sdk/evaluation/team/team_metrics.h"
#include "sdk/evaluation/team/team_object_figures.h"
#include "sdk/flight/truth_of_flight.h"
#include "sdk/terminal/terminal.h"

namespace karst::flight {
namespace {

namespace fs = std::filesystem;

/// Radius of the search for the rock nearest to a map cell; a cell farther away counts as wrong.
constexpr double kRockSearch_m = 20.0;

std::shared_ptr<const core::FlightRegion> region_of_run(const fs::path& run_dir) {
  const std::string file = (run_dir / "mission.info").string();
  return core::region_in(file, core::read_info(file));
}

/// The keys of the cave's mesh, as far as the run recorded them.
core::MeshKeys recorded_mesh_keys(const fs::path& file, const boost::property_tree::ptree& mission) {
  core::MeshKeys keys;
  core::OptionTable table;
  table.section("cave", keys);
  for (const auto& row : table.rows())
    if (const auto value = mission.get_optional<std::string>(row.key))
      table.set(file.string(), row.key, *value);
  return keys;
}

double cell_size_m(const fs::path& run_dir) {
  core::MapOptions map;
  core::OptionTable table;
  table.section("map", map);
  const auto tree = core::read_info((run_dir / "mission.info").string());
  if (const auto text = tree.get_optional<std::string>("map.resolution"))
    table.set((run_dir / "mission.info").string(), "map.resolution", *text);
  return map.resolution_m;
}

/// Ground truth from the cave's mesh. Its functions own the cave that they query.
evaluation::Truth truth_of(const Finishing& how, double resolution_m,
                           const std::shared_ptr<const core::FlightRegion>& region,
                           const std::vector<evaluation::PicturePose>& pictures) {
  const auto cave = std::make_shared<cave::Cave>(cave::load_cave(how.cave, how.start, how.mesh));
  evaluation::ReachableOptions options;  // its clearance is not the mission's: coverage compares missions
  options.resolution_m = resolution_m;
  const core::Vec3& start = cave->description.start.position;
  const auto reachable = std::make_shared<evaluation::Reachable>(
      evaluation::find_reachable_once(cave->scene.mesh(), start, options, how.cave, how.cave_cache));
  if (region) *reachable = evaluation::reachable_in_region(*reachable, *region, start, how.cave);
  evaluation::Truth truth;
  truth.reachable_volume_m3 = reachable->volume_m3();
  truth.is_reachable = [reachable, resolution_m](const core::Vec3& p) {
    const Eigen::Vector3d k = (p / resolution_m).array().floor();
    return reachable->contains({static_cast<int>(k.x()), static_cast<int>(k.y()), static_cast<int>(k.z())});
  };
  truth.surface = evaluation::surface_cells(*reachable);
  if (!pictures.empty()) truth.imaged_rock = evaluation::imaged_rock(cave->scene, pictures, resolution_m);
  truth.distance_to_rock = [cave](const core::Vec3& p) {
    return cave->scene.distance_to_rock(p, kRockSearch_m);
  };
  return truth;
}

/// Keeps the metrics that need the cave's mesh as last written, if the cave can no longer be read.
void keep_known(nlohmann::ordered_json& metrics, const fs::path& run_dir) {
  const auto before = core::json_of_file<nlohmann::ordered_json>(run_dir / "metrics.json");
  if (!before.is_object()) return;
  std::string kept;
  for (const char* key : evaluation::kCaveFigures) {
    const auto value = before.find(key);
    if (value == before.end() || !value->is_number() || !metrics[key].is_null()) continue;
    metrics[key] = *value;
    kept += (kept.empty() ? "" : ", ") + std::string(key);
  }
  if (!kept.empty()) print_error("karst: kept from the metrics.json there was: %s\n", kept.c_str());
}

/// Adds the reason to `problems` if the cave cannot be read.
evaluation::Truth truth_if_known(const fs::path& run_dir, const Finishing& how,
                                 std::vector<std::string>& problems, bool& lost_cave) {
  if (how.cave.empty()) return {};
  try {
    return truth_of(how, cell_size_m(run_dir), region_of_run(run_dir),
                    evaluation::read_picture_poses(run_dir / "ground_truth_frames.csv", problems));
  } catch (const core::InputError& e) {
    lost_cave = true;
    print_wrapped(stderr, 7, "karst: coverage is not known: %s\n", e.what());
    return {};
  }
}

/// Uses the columns of a run's telemetry, so that tools that read a run's volume over time can read a team's.
void write_team_telemetry(const evaluation::TeamRecord& team) {
  std::string text = "t_s,phase,explored_m3\n";
  const auto* t_s = team.merged.telemetry.times();
  const auto* volume = team.merged.telemetry.column("explored_m3");
  const double begin_s = evaluation::flight_begin_s(team.merged);
  for (std::size_t i = 0; t_s && volume && i < t_s->size(); ++i) {
    char line[64];
    std::snprintf(line, sizeof line, "%.0f,%s,%.3f\n", (*t_s)[i], (*t_s)[i] < begin_s ? "standby" : "flying",
                  (*volume)[i]);
    text += line;
  }
  evaluation::write_whole_file(team.directory / "telemetry.csv", text);
}

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The options of the vehicle's own mission: some metrics need its battery. A mission of another vehicle
/// ignores them.
void add_vehicle_section(const fs::path& mission_info, const fs::path& vehicle_mission_info) {
  const auto vehicle = core::read_info(vehicle_mission_info.string());
  const std::string name = vehicle.get("vehicle", "");
  const auto section = vehicle.get_child_optional(name);
  if (name.empty() || !section) return;
  auto mission = core::read_info(mission_info.string());
  mission.put_child(name, *section);
  std::ostringstream text;
  boost::property_tree::write_info(text, mission);
  evaluation::write_whole_file(mission_info, text.str());
}

/// What a simulated vehicle writes (plugins/simulator/truth_log.h).
constexpr const char* kTruthFiles[] = {"ground_truth.tum", "truth.csv", "truth_events.jsonl",
                                       "ground_truth_frames.csv", "truth_objects.jsonl"};

}  // namespace

Finishing recorded_finishing(const fs::path& run_dir, Report report) {
  const fs::path file = run_dir / "mission.info";
  std::error_code absent;
  const auto unknown = [report](const std::string& why) {
    Finishing how{"", "", report};
    how.problem = why + ": the cave is not known";
    return how;
  };
  if (!fs::exists(file, absent)) return unknown(file.string() + ": is not there");
  try {
    const auto mission = core::read_info(file.string());
    return {mission.get("cave.file", ""),
            mission.get("cave.start", ""),
            report,
            {},
            recorded_mesh_keys(file, mission)};
  } catch (const core::InputError& e) {
    return unknown(e.what());
  }
}

void take_truth(const fs::path& run_dir, const fs::path& truth, Report report) {
  if (!fs::is_regular_file(truth / "ground_truth.tum"))
    throw core::InputError(truth.string(), "",
                           "holds no ground_truth.tum: is it a folder of karst vehicle serve --truth?");
  check_same_flight(run_dir, truth);
  const Finishing how = recorded_finishing(truth, report);
  for (const char* file : kTruthFiles) {
    if (!fs::is_regular_file(truth / file)) continue;
    std::error_code error;
    if (fs::exists(run_dir / file) && bytes_of(run_dir / file) != bytes_of(truth / file))
      throw core::InputError((run_dir / file).string(), "",
                             "is there, and differs from that of " + truth.string());
    fs::copy_file(truth / file, run_dir / file, fs::copy_options::overwrite_existing, error);
    if (error) throw core::InputError((run_dir / file).string(), "", "cannot be written: " + error.message());
  }
  add_vehicle_section(run_dir / "mission.info", truth / "mission.info");
  finish_run(run_dir, how);
}

nlohmann::json finish_run(const fs::path& run_dir, const Finishing& how) {
  std::vector<std::string> problems, run_problems;
  bool lost_cave = false;
  const evaluation::Truth truth = truth_if_known(run_dir, how, problems, lost_cave);
  nlohmann::ordered_json metrics = evaluation::evaluate_run(run_dir, truth, &run_problems);
  if (!how.problem.empty()) problems.insert(problems.begin(), how.problem);
  for (const std::string& p : run_problems)
    if (!how.problem.starts_with(p)) problems.push_back(p);  // mission.info is read for both
  if (lost_cave) keep_known(metrics, run_dir);
  for (const std::string& p : problems) print_wrapped(stderr, 7, "karst: %s\n", p.c_str());
  evaluation::write_metrics(run_dir, metrics);
  if (how.report == Report::written)
    evaluation::write_report(run_dir, cave_drawing::report_drawings(run_dir));
  return metrics;
}

void finish_team(const fs::path& run_dir, const Finishing& how, nlohmann::ordered_json& metrics) {
  evaluation::TeamRecord team = evaluation::read_team(run_dir);
  std::vector<std::string> problems;
  bool lost_cave = false;
  const evaluation::Truth truth = truth_if_known(run_dir, how, problems, lost_cave);
  if (!how.problem.empty()) problems.insert(problems.begin(), how.problem);
  metrics.update(evaluation::team_map_figures(team, truth));
  evaluation::set_figures(metrics, evaluation::team_object_figures(team, team.problems));
  problems.insert(problems.end(), team.problems.begin(), team.problems.end());  // robots' are reported
  if (lost_cave) keep_known(metrics, run_dir);
  for (const std::string& p : problems) print_wrapped(stderr, 7, "karst: %s\n", p.c_str());
  evaluation::write_metrics(run_dir, metrics);
  write_team_telemetry(team);
  if (how.report == Report::written) evaluation::write_team_report(team, metrics);
}

}  // namespace karst::flight
