#include "sdk/tools/report_command.h"

#include <CLI/CLI.hpp>
#include <boost/property_tree/ptree.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/json_file.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/options.h"
#include "plugins/simulator/cave/cave.h"
#include "sdk/evaluation/flight_figures.h"
#include "sdk/evaluation/imaged_rock.h"
#include "sdk/evaluation/metrics.h"
#include "sdk/evaluation/object_figures.h"
#include "sdk/evaluation/reachable_file.h"
#include "sdk/evaluation/report.h"
#include "sdk/evaluation/surface.h"
#include "sdk/evaluation/team_folders.h"
#include "sdk/evaluation/team_metrics.h"
#include "sdk/evaluation/team_report.h"
#include "sdk/evaluation/whole_file.h"
#include "sdk/tools/campaign_page.h"
#include "sdk/tools/team_metrics.h"
#include "sdk/tools/terminal.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;

/// Farther from rock than this, a map cell is simply wrong; the search for its nearest rock ends here.
constexpr double kRockSearch_m = 20.0;

double cell_size_m(const fs::path& run_dir) {
  core::MapOptions map;
  core::OptionTable table;
  table.section("map", map);
  const auto tree = core::read_info((run_dir / "mission.info").string());
  if (const auto text = tree.get_optional<std::string>("map.resolution"))
    table.set((run_dir / "mission.info").string(), "map.resolution", *text);
  return map.resolution_m;
}

/// What the cave's mesh says. Holds the cave that its functions look into.
evaluation::Truth truth_of(const std::string& cave_file, const std::string& start, double resolution_m,
                           const std::vector<evaluation::PicturePose>& pictures, const fs::path& cache) {
  const auto cave = std::make_shared<cave::Cave>(cave::load_cave(cave_file, start));
  evaluation::ReachableOptions options;  // its clearance is not the mission's: coverage compares missions
  options.resolution_m = resolution_m;
  const auto reachable = std::make_shared<evaluation::Reachable>(evaluation::find_reachable_once(
      cave->scene.mesh(), cave->description.start.position, options, cave_file, cache));
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

/// What only the cave's mesh can say stays as it was last written, if the cave can no longer be read.
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

/// Says why if the cave cannot be read.
evaluation::Truth truth_if_known(const fs::path& run_dir, const std::string& cave, const std::string& start,
                                 std::vector<std::string>& problems, bool& lost_cave, const fs::path& cache) {
  if (cave.empty()) return {};
  try {
    return truth_of(cave, start, cell_size_m(run_dir),
                    evaluation::read_picture_poses(run_dir / "ground_truth_frames.csv", problems), cache);
  } catch (const core::InputError& e) {
    lost_cave = true;
    print_error("karst: coverage is not known: %s\n", e.what());
    return {};
  }
}

/// In the columns of a run's, so that what reads how a run's volume grew reads a team's.
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

/// Of a flight that was killed: it wrote no metrics.json.
nlohmann::ordered_json metrics_of_cut_team(const fs::path& run, const std::string& cave,
                                           const std::vector<nlohmann::json>& robots) {
  const auto info = core::read_info((run / "mission.info").string());
  return begin_team_metrics({info.get("policy.name", ""), cave, info.get("seed", std::int64_t{0}), "aborted",
                             "the record ends without an outcome"},
                            robots);
}

/// Evaluates each robot again, and the team. What only the mission itself knew stays as its end wrote it.
void report_team(const fs::path& run, const std::string& cave, const std::string& start, bool with_report) {
  const char* written = with_report ? "report.html" : "metrics.json";
  std::vector<nlohmann::json> own;
  for (const fs::path& robot : evaluation::robot_folders(run)) {
    own.push_back(finish_run(robot, cave, start, with_report));
    print_out("%s\n", (robot / written).c_str());
  }
  auto metrics = core::json_of_file<nlohmann::ordered_json>(run / "metrics.json");
  if (!metrics.is_object()) {
    print_error("karst: %s: not there or no JSON object: outcomes of the team are not known\n",
                (run / "metrics.json").c_str());
    metrics = metrics_of_cut_team(run, cave, own);
  }
  add_sums(metrics, own);
  finish_team(run, cave, start, metrics, with_report);
  print_out("%s\n", (run / written).c_str());
}

}  // namespace

nlohmann::json finish_run(const fs::path& run_dir, const std::string& cave, const std::string& start,
                          bool with_report, const fs::path& cave_cache) {
  std::vector<std::string> problems, run_problems;
  bool lost_cave = false;
  const evaluation::Truth truth = truth_if_known(run_dir, cave, start, problems, lost_cave, cave_cache);
  nlohmann::ordered_json metrics = evaluation::evaluate_run(run_dir, truth, &run_problems);
  problems.insert(problems.end(), run_problems.begin(), run_problems.end());
  if (lost_cave) keep_known(metrics, run_dir);
  for (const std::string& p : problems) print_error("karst: %s\n", p.c_str());
  evaluation::write_metrics(run_dir, metrics);
  if (with_report) evaluation::write_report(run_dir);
  return metrics;
}

void print_objects(const nlohmann::json& m) {
  if (!m["objects_placed"].is_number()) return;
  const auto count = [&](const char* key) { return m[key].get<int>(); };
  print_out("  objects          %d placed, %d in view in six images, %d found; %d known at the base",
            count("objects_placed"), count("objects_seen"), count("objects_found"),
            count("objects_reported"));
  if (m["object_error_m"].is_number())
    print_out(", %.2f m off, after %.0f s", m["object_error_m"].get<double>(),
              m["object_report_time_s"].get<double>());
  print_out("%s\n", count("objects_false") > 0
                        ? (", and " + std::to_string(count("objects_false")) + " false").c_str()
                        : "");
}

void finish_team(const fs::path& run_dir, const std::string& cave, const std::string& start,
                 nlohmann::ordered_json& metrics, bool with_report, const fs::path& cave_cache) {
  evaluation::TeamRecord team = evaluation::read_team(run_dir);
  std::vector<std::string> problems;
  bool lost_cave = false;
  const evaluation::Truth truth = truth_if_known(run_dir, cave, start, problems, lost_cave, cave_cache);
  metrics.update(evaluation::team_map_figures(team, truth));
  evaluation::set_figures(metrics, evaluation::team_object_figures(team, team.problems));
  problems.insert(problems.end(), team.problems.begin(), team.problems.end());  // robots' are told already
  if (lost_cave) keep_known(metrics, run_dir);
  for (const std::string& p : problems) print_error("karst: %s\n", p.c_str());
  evaluation::write_metrics(run_dir, metrics);
  write_team_telemetry(team);
  if (with_report) evaluation::write_team_report(team, metrics);
}

void add_report_command(CLI::App& app) {
  struct Arguments {
    std::string run, metric;
    bool no_report = false, worst = false;
  };
  auto args = std::make_shared<Arguments>();
  CLI::App* report = app.add_subcommand(
      "report",
      "Evaluate a run directory again and rewrite its metrics.json and report.html; also for a run that was "
      "cut short. Or write the report of a campaign, also while it flies.\n\n"
      "  karst report runs/demo\n  karst report runs/CAMPAIGN --worst");
  report->add_option("run", args->run, "run directory, or a campaign's folder or store")->required();
  report->add_flag("--no-report", args->no_report, "of a run: metrics only, no report.html");
  report->add_option("--metric", args->metric,
                     "of a campaign: the figure that its verdict is about; default: as it declared");
  report->add_flag("--worst", args->worst,
                   "of a campaign: write the mission reports of its worst trials, too");
  report->callback([args] {
    const fs::path run = args->run;
    if (is_campaign(run)) {
      print_out("%s\n", write_campaign_page(run, args->metric, args->worst).c_str());
      return;
    }
    if (!fs::exists(run / "mission.info"))
      throw core::InputError(args->run, "",
                             "no run directory, as it holds no mission.info, nor a campaign's folder");
    const auto info = core::read_info((run / "mission.info").string());
    if (evaluation::is_team(run)) {
      report_team(run, info.get("cave.file", ""), info.get("cave.start", ""), !args->no_report);
      return;
    }
    finish_run(run, info.get("cave.file", ""), info.get("cave.start", ""), !args->no_report);
    print_out("%s\n", (run / (args->no_report ? "metrics.json" : "report.html")).c_str());
  });
}

}  // namespace karst::tools
