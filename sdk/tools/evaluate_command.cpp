#include "sdk/tools/evaluate_command.h"

#include <CLI/CLI.hpp>
#include <boost/property_tree/ptree.hpp>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/options.h"
#include "sdk/cave_drawing/report_drawings.h"
#include "sdk/evaluation/accuracy/map_reference.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/evaluation/report/report.h"
#include "sdk/flight/finish_run.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct EvaluateArguments {
  std::string run, truth, reference, map;
  double density_per_m2 = 400;
  evaluation::EvaluateOptions options;
  bool no_align = false, json = false;
};

boost::property_tree::ptree settings_of(const fs::path& run) {
  if (!fs::is_regular_file(run / "mission.info")) return {};
  return core::read_info((run / "mission.info").string());
}

/// The cave a run was flown in, if its mission names one that is still there.
std::string cave_of(const fs::path& run) {
  const std::string cave = settings_of(run).get("cave.file", "");
  return fs::is_regular_file(cave) ? cave : "";
}

std::string text(const ordered_json& v, const char* format, double factor = 1) {
  if (!v.is_number()) return "unknown";
  std::array<char, 64> out;
  std::snprintf(out.data(), out.size(), format, factor * v.get<double>());
  return out.data();
}

void print_row(const char* name, const ordered_json& s, const char* unit, double factor) {
  if (s["count"] == 0) {
    print_out("  %-28s none: the trajectory is too short\n", name);
    return;
  }
  print_out("  %-28s", name);
  for (const char* key : {"rmse", "mean", "median", "std", "min", "max"})
    print_out(" %9s", text(s[key], "%.4f", factor).c_str());
  print_out("  %s\n", unit);
}

void print_trajectory(const ordered_json& e) {
  constexpr double kDegrees = 57.29577951308232;
  print_out("Trajectory against %s: %zu pairs of %zu poses, alignment %s, path %s\n",
            e["truth"].get<std::string>().c_str(), e["pairs"].get<std::size_t>(),
            e["poses"].get<std::size_t>(), e["alignment"]["kind"].get<std::string>().c_str(),
            text(e["path_length_m"], "%.2f m").c_str());
  print_out("  %-28s %9s %9s %9s %9s %9s %9s\n", "", "rmse", "mean", "median", "std", "min", "max");
  print_row("absolute, translation", e["ape"]["translation_m"], "m", 1);
  print_row("absolute, rotation", e["ape"]["rotation_rad"], "deg", kDegrees);
  for (const auto& [key, unit, delta] :
       {std::tuple{"by_distance", "m", "delta_m"}, {"by_frames", "frames", "delta_frames"}}) {
    const std::string stretch = "relative, " + text(e["rpe"][key][delta], "%g ") + unit;
    print_row((stretch + ", transl.").c_str(), e["rpe"][key]["translation_m"], "m", 1);
    print_row((stretch + ", rot.").c_str(), e["rpe"][key]["rotation_rad"], "deg", kDegrees);
  }
  const ordered_json& d = e["drift"];
  print_out("  drift at the end            %s (%s of the path)\n", text(d["end_error_m"], "%.3f m").c_str(),
            text(d["end_percent"], "%.3f %%").c_str());
  if (d["segments"] != 0)
    print_out("  drift over segments         %s, %s a metre (%zu segments of 1 to 8 times %s)\n",
              text(d["segment_percent"], "%.3f %%").c_str(),
              text(d["segment_rotation_radpm"], "%.4f deg", kDegrees).c_str(),
              d["segments"].get<std::size_t>(), text(d["segment_unit_m"], "%g m").c_str());
  print_out("  heading error (rms)         %s\n", text(e["heading_error_rad"], "%.3f deg", kDegrees).c_str());
}

void print_map(const ordered_json& e) {
  print_out("Map against %s: %zu points, nearest of %zu", e["reference"].get<std::string>().c_str(),
            e["points"].get<std::size_t>(), e["reference_points"].get<std::size_t>());
  if (e["density_per_m2"].is_number())
    print_out(" (%s of the mesh)", text(e["density_per_m2"], "%g a m^2").c_str());
  print_out("\n  map error                   mean %s, std %s, median %s, max %s\n",
            text(e["error_m"]["mean"], "%.3f m").c_str(), text(e["error_m"]["std"], "%.3f m").c_str(),
            text(e["error_m"]["median"], "%.3f m").c_str(), text(e["error_m"]["max"], "%.2f m").c_str());
}

ordered_json without_plots(ordered_json e) {
  for (ordered_json& part : e)
    if (part.is_object()) part.erase("plots");
  return e;
}

void evaluate(const EvaluateArguments& args) {
  const fs::path run = args.run;
  const bool is_run = fs::is_directory(run);
  if (!is_run && !fs::is_regular_file(run))
    throw core::InputError(args.run, "", "no such run directory or trajectory");
  if (fs::is_regular_file(run / "team.jsonl"))
    throw core::InputError(
        args.run, "",
        "the run directory of a team: evaluate its robots', " + (run / "robot_1").string() + " and so on");
  std::vector<std::string> problems;
  evaluation::EvaluateOptions options = args.options;
  options.align = !args.no_align;
  ordered_json result{{"schema", "karst.evaluation/1"}};

  std::string truth_file = args.truth;
  std::string reference = args.reference;
  const bool truth_of_vehicle = fs::is_directory(args.truth);
  if (truth_of_vehicle) {
    if (!is_run) throw core::InputError(args.truth, "", "a folder of truth completes a run directory only");
    flight::take_truth(
        run, args.truth,
        fs::is_regular_file(run / "report.html") ? flight::Report::written : flight::Report::none);
    truth_file.clear();
    if (reference.empty()) reference = cave_of(args.truth);
  }
  if (truth_file.empty() && is_run && fs::is_regular_file(run / "ground_truth.tum"))
    truth_file = (run / "ground_truth.tum").string();
  result["trajectory"] = nullptr;
  if (!truth_file.empty()) {
    const std::string estimate_file = is_run ? (run / "trajectory.tum").string() : args.run;
    const auto estimate = evaluation::read_poses(estimate_file, {}, problems);
    const auto truth = evaluation::read_poses(truth_file, estimate, problems);
    options.own_frame = !args.truth.empty() && !truth_of_vehicle;
    if (is_run) options.time_origin_s = settings_of(run).get("replay.time_origin", 0.0);
    result["trajectory"] = evaluation::trajectory_evaluation(truth, estimate, options, truth_file);
  }

  std::string map_file = args.map;
  if (map_file.empty() && is_run)
    for (const char* name : {"map.ply", "map.bt"})
      if (fs::is_regular_file(run / name)) map_file = (run / name).string();
  if (reference.empty() && is_run) reference = cave_of(run);
  result["map"] = nullptr;
  if (!reference.empty()) {
    if (map_file.empty()) throw core::InputError(args.run, "", "has no map to compare; name one with --map");
    const auto points = evaluation::read_map_points(map_file);
    result["map"] = evaluation::map_evaluation(
        points, evaluation::open_reference(reference, args.density_per_m2, points));
    result["map"]["file"] = map_file;
  }
  for (const std::string& p : problems) print_wrapped(stderr, 7, "karst: %s\n", p.c_str());
  if (result["trajectory"].is_null() && result["map"].is_null())
    throw core::InputError(args.run, "", "nothing to compare it with: name a --truth or a --reference");

  const fs::path out = is_run ? run / "evaluation.json" : fs::path(args.run + ".evaluation.json");
  evaluation::write_whole_file(out, core::json_text(result, 1) + "\n");
  const bool with_report = is_run && fs::is_regular_file(run / "report.html");
  if (with_report) evaluation::write_report(run, cave_drawing::report_drawings(run));
  if (args.json) {
    print_json(without_plots(result));
    return;
  }
  if (!result["trajectory"].is_null()) print_trajectory(result["trajectory"]);
  if (!result["map"].is_null()) print_map(result["map"]);
  print_out("Look next at:\n  %s   all figures\n", out.c_str());
  if (with_report) print_out("  %s   with plots of the errors\n", (run / "report.html").c_str());
}

}  // namespace

void add_evaluate_command(CLI::App& app) {
  auto args = std::make_shared<EvaluateArguments>();
  CLI::App* command = app.add_subcommand(
      "evaluate",
      "Measure a run: errors of its trajectory against the truth, and of its map against a reference\n\n"
      "  karst evaluate runs/demo                                    a simulated flight: truth and cave are "
      "known\n"
      "  karst evaluate runs/kitti00 --truth poses.txt               TUM, or KITTI's 3x4 matrices\n"
      "  karst evaluate slam.tum --truth truth.tum --no-align --json\n"
      "  karst evaluate runs/cave --reference scanner.pcd            map error, point to point\n\n"
      "Writes evaluation.json into the run (or beside the trajectory) and adds plots to its report.");
  command->add_option("run", args->run, "run directory, or a trajectory (TUM)")
      ->type_name(kFile)
      ->required()
      ->check(not_empty());
  command
      ->add_option("--truth", args->truth,
                   "true poses, or a folder of karst vehicle serve --truth, which completes the run; "
                   "default: the run's "
                   "ground_truth.tum")
      ->type_name(kFile)
      ->check(not_empty());
  command
      ->add_option("--reference", args->reference,
                   "cave .info, mesh or cloud (PCD, PLY) to measure the map against; default: the run's cave")
      ->type_name(kFile)
      ->check(not_empty());
  command->add_option("--map", args->map, "map to measure (.bt, .ot, .ply, .pcd); default: the run's")
      ->type_name(kFile)
      ->check(not_empty());
  command
      ->add_option("--density", args->density_per_m2, "points a square metre, where the reference is a mesh")
      ->capture_default_str()
      ->check(number_in(0.1, 1e5));
  command->add_flag("--no-align", args->no_align, "compare as they are, without a best fit");
  command->add_flag("--scale", args->options.scale, "fit the scale as well");
  command
      ->add_option("--max-difference", args->options.max_difference_s,
                   "seconds between stamps of the same moment")
      ->capture_default_str()
      ->check(number_in(0.0, 10.0));
  command->add_option("--delta", args->options.delta_m, "metres of path for the relative error")
      ->capture_default_str()
      ->check(number_in(1e-3, 1e5));
  command->add_option("--delta-frames", args->options.delta_frames, "poses for the relative error")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  command->add_flag("--json", args->json, "print evaluation.json without its plots");
  command->callback([args] { evaluate(*args); });
}

}  // namespace karst::tools
