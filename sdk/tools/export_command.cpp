#include "sdk/tools/export_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <string>
#include <system_error>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/printable.h"
#include "core_stack/common/rounded.h"
#include "core_stack/common/shell_word.h"
#include "plugins/simulator/cave/cave_blocks.h"
#include "sdk/mcap_export/export_mcap.h"
#include "sdk/survey_export/export_run.h"
#include "sdk/survey_export/geographic_system.h"
#include "sdk/survey_export/leg_words.h"
#include "sdk/survey_export/new_legs.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;
using core::InputError;
using survey_export::RunSurvey;
using survey_export::WallMesh;

struct ExportArguments {
  std::string run, out, mcap, fix, system, prior;
  double declination_deg = 0;
  std::optional<double> epoch_s;
  bool no_fix = false, force = false, json = false;
};

survey_export::Placing placing_of(const ExportArguments& args) {
  survey_export::Placing placing;
  placing.declination_deg = args.declination_deg;
  placing.system = args.system;
  placing.fixed = !args.no_fix;
  // Names that Survex and Therion share.
  static const std::regex known("(EPSG|ESRI):[0-9]{4,6}|UTM([1-9]|[1-5][0-9]|60)[NS]");
  if (survey_export::is_geographic(args.system))
    throw InputError("command line", "--cs",
                     "expected a system in metres such as EPSG:32633 or UTM33N; " + args.system +
                         " is latitude and longitude, in degrees");
  if (!args.system.empty() && !std::regex_match(args.system, known))
    throw InputError("command line", "--cs",
                     "expected a system in metres such as EPSG:32633 or UTM33N, got \"" + args.system + "\"");
  if (!args.fix.empty()) placing.start_m = cave::read_vector("command line", "--fix", args.fix);
  return placing;
}

survey_export::OtherPrior prior_of(const ExportArguments& args) {
  if (args.prior.empty()) return std::nullopt;
  return args.prior == "none" ? fs::path() : fs::path(args.prior);
}

/// The files name each other, and Therion reads neither quotes in such a name nor bytes that are no UTF-8.
void check_name(const ExportArguments& args) {
  const std::string name = fs::path(args.out).filename().string();
  if (name.empty())
    throw InputError("command line", "--survey", "expected a path without ending, got a folder: " + args.out);
  if (name.find_first_of("\"\n\t") != std::string::npos || core::printable(name) != name)
    throw InputError("command line", "--survey",
                     "expected a name in UTF-8 without quotes and control characters, got " + args.out);
}

/// Makes the folder of the files, and refuses to overwrite them.
void check_out(const ExportArguments& args) {
  const fs::path parent = fs::path(args.out).parent_path();
  std::error_code error;
  if (!parent.empty()) fs::create_directories(parent, error);
  if (error) throw InputError(parent.string(), "", "cannot be made: " + error.message());
  for (const fs::path& file : survey_export::survey_files(args.out))
    if (fs::exists(file) && !args.force)
      throw InputError(file.string(), "", "is there already; choose another --survey, or give --force");
}

struct Sums {
  std::size_t approximate = 0, continuations = 0;
  double length_m = 0, approximate_m = 0;
};
Sums sums_of(const survey::Survey& survey) {
  Sums sums;
  for (const survey::Leg& leg : survey.legs) {
    const double length_m = leg.length_m.value_or(0);
    sums.length_m += length_m;
    if (!leg.approximate) continue;
    ++sums.approximate;
    sums.approximate_m += length_m;
  }
  for (const survey::Station& s : survey.stations) sums.continuations += s.continuation ? 1u : 0u;
  return sums;
}

nlohmann::ordered_json json_of(const RunSurvey& run, const WallMesh& walls, const std::string& out) {
  const Sums sums = sums_of(run.flown.survey);
  const survey_export::Accuracy& a = run.flown.accuracy;
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  for (const fs::path& file : survey_export::survey_files(out)) files.push_back(file.string());
  nlohmann::ordered_json j = {
      {"schema", "karst.export/1"},
      {"name", run.flown.name},
      {"stations", run.flown.survey.stations.size()},
      {"legs", run.flown.survey.legs.size()},
      {"length_m", core::to_millionths(sums.length_m)},
      {"approximate_legs", sums.approximate},
      {"approximate_m", core::to_millionths(sums.approximate_m)},
      {"continuations", sums.continuations},
      {"blocked_legs", run.flown.blocked_legs},
      {"cell_sd_m", core::to_millionths(a.leg_sd_m(0))},
      {"drift_sd_m_per_root_m", core::to_millionths(std::sqrt(a.growth_m2_per_m))},
      {"drift_scans", a.scans},
      {"offset_m",
       {core::to_millionths(run.flown.offset_m.x()), core::to_millionths(run.flown.offset_m.y()),
        core::to_millionths(run.flown.offset_m.z())}},
      {"triangles", walls.mesh.triangles.size()},
      {"open_edges", walls.open_edges},
      {"files", files},
      {"problems", run.problems}};
  if (!run.flown.leg_is_new.empty()) {
    const survey_export::NewSum sum = survey_export::new_sum(run.flown);
    j["new_legs"] = sum.legs;
    j["new_m"] = core::to_millionths(sum.length_m);
  }
  return j;
}

void print(const RunSurvey& run, const WallMesh& walls, const ExportArguments& args) {
  const survey::Survey& s = run.flown.survey;
  const Sums sums = sums_of(s);
  print_out("%s: %s, %s, %.1f m\n", run.flown.name.c_str(),
            core::counted(s.stations.size(), "station").c_str(), core::counted(s.legs.size(), "leg").c_str(),
            sums.length_m);
  if (sums.approximate > 0)
    print_out("  seen, but not flown: %s, %.1f m (approximate)\n",
              core::counted(sums.approximate, "leg").c_str(), sums.approximate_m);
  if (const std::string words = survey_export::new_words(run.flown); !words.empty())
    print_out("  %s\n", words.c_str());
  if (sums.continuations > 0)
    print_out("  goes on at %s\n", core::counted(sums.continuations, "station").c_str());
  if (run.flown.blocked_legs > 0)
    print_out("  neighbours that do not see each other: %s\n",
              core::counted(run.flown.blocked_legs, "pair").c_str());
  print_wrapped(stdout, 2, "  %s\n", survey_export::accuracy_words(run.flown.accuracy).c_str());
  if (const core::Vec3& o = run.flown.offset_m; !o.isZero() && args.fix.empty())
    print_wrapped(stdout, 2,
                  "  coordinates: those of the survey %s; the cave's origin is at %.3f %.3f %.3f\n",
                  run.prior.c_str(), o.x(), o.y(), o.z());
  if (args.no_fix) print_out("  no station is fixed\n");
  print_out("  walls: %s triangles\n", core::grouped(walls.mesh.triangles.size()).c_str());
  for (const std::string& problem : run.problems) print_error("%s\n", problem.c_str());
  std::string files;
  for (const fs::path& file : survey_export::survey_files(args.out))
    files += (files.empty() ? "" : ", ") + file.string();
  print_wrapped(stdout, 2, "written: %s\n", files.c_str());
  print_out("next:\n  cavern %s\n  therion %s\n", core::shell_word(args.out + ".svx").c_str(),
            core::shell_word(args.out + ".thconfig").c_str());
}

void export_survey(const ExportArguments& args) {
  const survey_export::Placing placing = placing_of(args);
  check_name(args);
  const RunSurvey run =
      survey_export::survey_of_run(args.run, fs::path(args.out).filename().string(), prior_of(args));
  if (!placing.system.empty() && !placing.start_m && run.flown.offset_m.isZero())
    throw InputError("command line", "--cs",
                     "needs --fix: no survey of the mission says where the cave lies in " + placing.system);
  check_out(args);
  const WallMesh walls = survey_export::write_survey(run, placing, args.out);
  if (args.json)
    print_json(json_of(run, walls, args.out));
  else
    print(run, walls, args);
}

nlohmann::ordered_json json_of(const mcap::McapExport& made, const std::string& file) {
  nlohmann::ordered_json topics = nlohmann::ordered_json::array();
  for (const mcap::TopicCount& t : made.topics)
    topics.push_back({{"topic", t.name}, {"type", t.type}, {"messages", t.messages}});
  return {{"schema", "karst.export_mcap/1"},
          {"file", file},
          {"bytes", made.bytes},
          {"messages", made.messages},
          {"duration_s", core::to_millionths(made.duration_s)},
          {"epoch_s", core::to_millionths(core::seconds(made.epoch))},
          {"topics", topics},
          {"problems", made.problems}};
}

void export_mcap_file(const ExportArguments& args) {
  std::error_code ignored;
  if (fs::is_directory(args.mcap, ignored))
    throw InputError("command line", "--mcap", "expected a file, got a folder: " + args.mcap);
  if (fs::is_regular_file(args.mcap, ignored) && !args.force)
    throw InputError(args.mcap, "", "is there already; choose another --mcap, or give --force");
  const auto epoch = args.epoch_s ? std::optional(core::from_seconds(*args.epoch_s)) : std::nullopt;
  const mcap::McapExport made = mcap::export_mcap(args.run, args.mcap, epoch, KARST_VERSION);
  if (args.json) return print_json(json_of(made, args.mcap));
  print_out("%s: %.1f s, %s messages, %.1f MB\n", args.mcap.c_str(), made.duration_s,
            core::grouped(made.messages).c_str(), static_cast<double>(made.bytes) / 1e6);
  for (const mcap::TopicCount& t : made.topics)
    print_out("  %-32s %-32s %9s\n", t.name.c_str(), t.type.c_str(), core::grouped(t.messages).c_str());
  for (const std::string& problem : made.problems) print_error("%s\n", problem.c_str());
}

void export_run(const ExportArguments& args) {
  if (args.out.empty() && args.mcap.empty())
    throw InputError("command line", "", "expected --survey OUT or --mcap FILE: what to write");
  if (args.json && !args.out.empty() && !args.mcap.empty())
    throw InputError("command line", "--json", "expected one of --survey and --mcap");
  if (!args.out.empty()) export_survey(args);
  if (!args.mcap.empty()) export_mcap_file(args);
}

}  // namespace

void add_export_command(CLI::App& app) {
  auto args = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand(
      "export", "Write a flight for other programs: as a survey with its walls, or as an MCAP file");
  command->add_option("run", args->run, "Run directory")->type_name(kFolder)->required();
  auto* survey =
      command
          ->add_option(
              "--survey", args->out,
              "Path without ending: writes OUT.svx (Survex), OUT.th, OUT.thconfig and OUT_scan.th (Therion), "
              "OUT.stl and OUT.ply (walls), OUT.las (points)")
          ->type_name(kFile)
          ->check(not_empty());
  auto* mcap =
      command
          ->add_option(
              "--mcap", args->mcap,
              "Writes the whole flight as one file for Foxglove, RViz 2 and ros2 bag: poses, paths, map, "
              "frontiers, goals, events, pictures, scans")
          ->type_name(kFile)
          ->check(not_empty());
  command
      ->add_option(
          "--epoch", args->epoch_s,
          "With --mcap: time since 1970 at flight time 0, s (default: 0; of a replay, the recording's)")
      ->needs(mcap)
      ->check(number_in(0, 2e9));
  auto* fix = command
                  ->add_option(
                      "--fix", args->fix,
                      "\"x y z\" of the vehicle's centre at its start, m (default: as in the survey that the "
                      "mission had, else as in the map)")
                  ->check(not_empty());
  auto* system =
      command
          ->add_option("--cs", args->system,
                       "Coordinate system of --fix, or of the mission's survey, such as EPSG:32633 or UTM33N")
          ->check(not_empty());
  auto* no_fix =
      command
          ->add_flag("--no-fix", args->no_fix,
                     "Fix no station in OUT.svx and OUT.th, to equate one with a station of another survey")
          ->excludes(fix)
          ->excludes(system);
  auto* prior =
      command
          ->add_option(
              "--prior", args->prior,
              "Survey to compare with instead of the one that the run's mission.info names; none: with none")
          ->type_name(kFile)
          ->check(not_empty());
  auto* declination =
      command
          ->add_option(
              "--declination", args->declination_deg,
              "From north to the map's y axis, clockwise, degrees; with --cs, from the north of its grid")
          ->check(number_in(-180, 180))
          ->capture_default_str();
  command->add_flag("--force", args->force, "Overwrite files that are there");
  command->add_flag("--json", args->json, "Write the summary as JSON");
  command->footer(
      "Examples:\n  karst export runs/monday --mcap monday.mcap\n"
      "  karst export runs/monday --survey surveys/monday\n"
      "  karst export runs/monday --survey surveys/monday --fix \"451234.5 5078123.0 812.4\" --cs UTM33N "
      "--declination 3.1");
  for (CLI::Option* of_survey : {fix, system, no_fix, prior, declination}) of_survey->needs(survey);
  command->callback([args] { export_run(*args); });
}

}  // namespace karst::tools
