#include "sdk/tools/from_survey_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/output_file.h"
#include "core_stack/common/shell_word.h"
#include "plugins/simulator/cave/cave_blocks.h"
#include "plugins/simulator/cave/propose_start.h"
#include "sdk/survey/read_survey.h"
#include "sdk/survey_cave/cave_from_survey.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"
#include "sdk/tools/cave_files.h"
#include "sdk/tools/from_survey_text.h"
#include "sdk/tools/step_progress.h"

namespace karst::tools {
namespace {

using core::InputError;
using survey_cave::CaveFromSurvey;
using survey_cave::CaveOptions;

struct FromSurveyArguments {
  std::string survey, out, start, box;
  CaveOptions options;
  bool force = false, json = false;
};

Eigen::AlignedBox3d read_box(const std::string& text) {
  std::istringstream in(text);
  core::Vec3 a, b;
  std::string more;
  if (!(in >> a.x() >> a.y() >> a.z() >> b.x() >> b.y() >> b.z()) || in >> more || !a.allFinite() ||
      !b.allFinite())
    throw InputError("command line", "--box", "expected \"x y z x y z\", two corners, got \"" + text + "\"");
  return {a.cwiseMin(b), a.cwiseMax(b)};
}

CaveOptions cave_options_of(const FromSurveyArguments& args) {
  CaveOptions options = args.options;
  if (!args.box.empty()) options.part.box = read_box(args.box);
  if (!args.start.empty()) options.start = cave::read_start("command line, --start", args.start);
  return options;
}

/// What repeats the command.
std::string survey_command_of(const FromSurveyArguments& args) {
  const CaveOptions& o = args.options;
  std::string text =
      "karst cave from-survey " + core::shell_word(args.survey) +
      core::format_text(" --resolution %g --roughness %g --seed %llu --vehicle-width %g --max-triangles %zu",
                        o.resolution_m, o.roughness_m, static_cast<unsigned long long>(o.seed),
                        o.vehicle_width_m, o.max_triangles);
  text += core::shell_option("--survey", o.part.survey) + core::shell_option("--around", o.part.around);
  if (!o.part.around.empty()) text += core::format_text(" --radius %g", o.part.radius_m);
  return text + core::shell_option("--box", args.box) + core::shell_option("--start", args.start);
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream out = core::open_output(path);
  out << text;
  out.flush();
  if (!out) throw InputError(path, "", "cannot be written");
}

std::string info_text(const CaveFiles& files, const FromSurveyArguments& args, const CaveFromSurvey& made,
                      const std::vector<std::string>& lines) {
  std::string text = comment_line("made by: " + survey_command_of(args));
  for (const std::string& line : lines) text += comment_line("  " + line);
  text += "mesh \"" + files.mesh_name + "\"\n";
  if (made.start) text += "start \"" + cave::start_text(*made.start) + "\"\n";
  return text + "reflectivity 0.5\n";
}

void make_from_survey(const FromSurveyArguments& args) {
  const CaveOptions options = cave_options_of(args);
  const CaveFiles files = new_cave_files(args.out, "ply", args.force);
  const std::string stations = args.out + ".stations.csv";
  if (std::filesystem::exists(stations) && !args.force)
    throw InputError(stations, "", "is there already; choose another --out, or give --force to overwrite it");
  StepProgress progress;
  progress("reading", 0);
  const survey::Survey survey = survey::read_survey(args.survey);
  const CaveFromSurvey made = survey_cave::cave_from_survey(
      args.survey, survey, options, [&](const char* step, double fraction) { progress(step, fraction); });
  progress.end();
  cave::write_mesh(files.mesh, made.mesh);
  const std::uintmax_t mesh_bytes = std::filesystem::file_size(files.mesh);
  const std::vector<std::string> lines = survey_lines(survey, made, mesh_bytes);
  write_text(files.info, info_text(files, args, made, lines));
  write_text(stations, stations_csv(survey, made));
  if (args.json) {
    nlohmann::ordered_json j = survey_json(survey, made, mesh_bytes);
    j["mesh"] = files.mesh;
    j["info"] = files.info;
    j["stations_table"] = stations;
    print_json(j);
    return;
  }
  print_out("%s%s\n", args.survey.c_str(), survey.title.empty() ? "" : (": " + survey.title).c_str());
  for (const std::string& line : lines) print_out("  %s\n", line.c_str());
  print_out("written: %s, %s, %s\nnext:\n  karst cave info %s\n  karst fly --cave %s\n", files.mesh.c_str(),
            files.info.c_str(), stations.c_str(), files.info.c_str(), files.info.c_str());
}

}  // namespace

void add_from_survey_command(CLI::App& cave) {
  auto args = std::make_shared<FromSurveyArguments>();
  CaveOptions& o = args->options;
  CLI::App* command = cave.add_subcommand(
      "from-survey",
      "Make a cave of a survey, with a report of what was guessed: writes OUT.ply, OUT.info and "
      "OUT.stations.csv");
  command
      ->add_option("survey", args->survey, "Therion (.th), Survex (.svx, .3d) or Compass (.dat, .mak, .plt)")
      ->type_name(kFile)
      ->required();
  command->add_option("--out,-o", args->out, "Path of the cave without ending, such as caves/demo")
      ->type_name(kFile)
      ->required()
      ->check(not_empty());
  command->add_option("--resolution", o.resolution_m, "Step of the grid on which the walls are found, m")
      ->check(number_in(0.05, 5.0))
      ->capture_default_str();
  command->add_option("--roughness", o.roughness_m, "Greatest displacement of the walls, m")
      ->check(number_in(0, 2.0))
      ->capture_default_str();
  command->add_option("--seed", o.seed, "Another seed, other walls")
      ->check(whole_64_bits())
      ->capture_default_str();
  command->add_option("--survey", o.part.survey, "Only this survey and those in it, such as system.branch")
      ->check(not_empty());
  auto* around =
      command->add_option("--around", o.part.around, "Only what is near this station")->check(not_empty());
  command->add_option("--radius", o.part.radius_m, "How near, m")
      ->check(number_in(1, 1e6))
      ->needs(around)
      ->capture_default_str();
  command->add_option("--box", args->box, "\"x y z x y z\", only what is in this box of the survey, m")
      ->check(not_empty());
  command->add_option("--start", args->start, "\"x y z [heading]\" in the cave to be made, m, z up")
      ->check(not_empty());
  command->add_option("--vehicle-width", o.vehicle_width_m, "Narrower passages are listed as out of reach, m")
      ->check(number_in(0.05, 10))
      ->capture_default_str();
  command->add_option("--max-triangles", o.max_triangles, "A cave of more is refused")
      ->check(CLI::Range(std::size_t{1000}, std::size_t{100'000'000}))
      ->capture_default_str();
  command->add_flag("--force", args->force, "Overwrite a cave that is there");
  command->add_flag("--json", args->json, "Write the report as JSON");
  command->footer(
      "Examples:\n  karst cave from-survey cave.svx --out caves/real\n"
      "  karst cave from-survey system.th --survey system.branch --resolution 0.2 --out caves/branch\n"
      "  karst cave from-survey system.3d --around branch.12 --radius 100 --out caves/near_12");
  command->callback([args] { make_from_survey(*args); });
}

}  // namespace karst::tools
