#include "sdk/tools/draw_command.h"

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "plugins/simulator/cave/cave_blocks.h"
#include "sdk/cave_drawing/map_drawings.h"
#include "sdk/cave_drawing/run_record.h"
#include "sdk/cave_drawing/survey_drawings.h"
#include "sdk/cave_drawing/svg_sheet.h"
#include "sdk/evaluation/page/pdf.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/evaluation/team/team_folders.h"
#include "sdk/survey/lower_case.h"
#include "sdk/survey/read_survey.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;
using cave_drawing::CaveDrawings;
using core::InputError;

constexpr double kDegree = std::numbers::pi / 180;

struct DrawArguments {
  std::string source, out, scale, entrance, name, date, paper = "a4";
  std::optional<double> bearing_deg;
  double declination_deg = 0;
  bool force = false;
};

/// "1:500" or "500".
double read_scale(const std::string& text) {
  const std::string number = text.starts_with("1:") ? text.substr(2) : text;
  double scale = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), scale);
  if (error != std::errc() || end != number.data() + number.size() || !(scale >= 1) || !(scale <= 1e6))
    throw InputError("command line", "--scale",
                     "expected a scale from 1:1 to 1:1000000, such as 1:500, got \"" + text + "\"");
  return scale;
}

std::string map_in(const fs::path& run) {
  if (evaluation::is_team(run) && !fs::exists(run / "map.bt"))
    throw InputError(run.string(), "",
                     "is the run of a team: name one of its robots, such as " + (run / "robot_1").string());
  for (const char* name : {"map.bt", "map.ot"})
    if (fs::exists(run / name)) return (run / name).string();
  throw InputError(run.string(), "", "holds no map.bt, which a flight writes at its end");
}

void expect_survey(const std::string& source) {
  const std::string ending = survey::ending_of(source);
  for (const char* known : {".th", ".svx", ".3d", ".dat", ".mak", ".plt"})
    if (ending == known) return;
  throw InputError(
      source, "",
      "cannot be drawn: it is no run directory, and by its name neither a map (.bt, .ot) nor a survey "
      "(.th, .svx, .3d, .dat, .mak, .plt)");
}

CaveDrawings drawings_of(const DrawArguments& args) {
  const fs::path source = args.source;
  std::optional<double> bearing_rad;
  if (args.bearing_deg) bearing_rad = *args.bearing_deg * kDegree;
  const std::string ending = source.extension().string();
  const bool is_run = fs::is_directory(source), is_map = ending == ".bt" || ending == ".ot";
  if (!is_run && !is_map) {
    expect_survey(args.source);
    if (!args.entrance.empty())
      throw InputError("command line", "--entrance", "is for maps; a survey names its own");
    return cave_drawing::survey_drawings(survey::read_survey(args.source), bearing_rad, args.source);
  }
  const std::string file = is_run ? map_in(source) : args.source;
  cave_drawing::FlightRecord record;
  if (is_run)
    record = cave_drawing::flight_record(source);
  else
    record.name = source.stem().string();
  if (!args.entrance.empty())
    record.entrance = cave::read_vector("command line", "--entrance", args.entrance);
  return cave_drawing::map_drawings(core::read_octomap(file), record, bearing_rad, file);
}

void write_drawings(const DrawArguments& args) {
  cave_drawing::SheetOptions sheet;
  sheet.paper = core::parse<cave_drawing::Paper>(args.paper).value_or(cave_drawing::Paper::a4);
  sheet.declination_rad = args.declination_deg * kDegree;
  if (!args.scale.empty()) sheet.scale = read_scale(args.scale);
  const char* path = std::getenv("PATH");
  const auto converter = evaluation::pdf_converter(path == nullptr ? "" : path);

  CaveDrawings drawings = drawings_of(args);
  if (!args.name.empty()) drawings.facts.name = args.name;
  if (!args.date.empty()) drawings.facts.date = args.date;
  // All are drawn before the first is written: a scale that does not fit leaves nothing behind.
  std::vector<std::pair<std::string, std::string>> files;
  for (const auto* drawing : {&drawings.plan, &drawings.extended, &drawings.projected}) {
    const bool is_empty = drawing->spaces.empty() && drawing->centreline.empty();
    if (is_empty) {
      print_error("karst: the %s view is left out: no passage is wide enough for it\n",
                  core::name_of(drawing->view));
      continue;
    }
    files.emplace_back(args.out + "." + core::name_of(drawing->view),
                       svg_sheet(*drawing, drawings.facts, sheet, args.source));
  }
  if (files.empty()) throw InputError(args.source, "", "no passage is wide enough to be drawn");
  for (const auto& [stem, svg] : files)
    for (const char* ending : {".svg", ".pdf"})
      if (!args.force && fs::exists(stem + ending))
        throw InputError(stem + ending, "", "is there already; --force overwrites it");
  if (const fs::path folder = fs::path(args.out).parent_path(); !folder.empty()) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw InputError(folder.string(), "", "cannot be made: " + error.message());
  }
  for (const auto& [stem, svg] : files) {
    evaluation::write_whole_file(stem + ".svg", svg);
    print_out("%s.svg\n", stem.c_str());
    if (!converter) continue;
    evaluation::write_pdf(*converter, stem + ".svg", stem + ".pdf");
    print_out("%s.pdf\n", stem.c_str());
  }
  if (!converter)
    print_wrapped(
        stderr, 7,
        "karst: no PDF: rsvg-convert is not there; apt-get install librsvg2-bin, and draw again with "
        "--force\n");
}

}  // namespace

void add_draw_command(CLI::App& app) {
  auto args = std::make_shared<DrawArguments>();
  CLI::App* command = app.add_subcommand(
      "draw",
      "Draw a cave as cavers do: plan, extended profile and projected profile, as SVG and PDF\n\n"
      "Writes OUT.plan.svg, OUT.extended.svg, OUT.projected.svg, and the same as PDF.");
  command
      ->add_option("source", args->source,
                   "A run directory, a map (.bt, .ot), or a survey (.th, .svx, .3d, .dat, .mak, .plt)")
      ->type_name(kFile)
      ->required()
      ->check(not_empty());
  command->add_option("--out,-o", args->out, "Path of the drawings without ending, such as drawings/demo")
      ->type_name(kFile)
      ->required()
      ->check(not_empty());
  command->add_option("--paper", args->paper, "a4, a3")
      ->check(CLI::IsMember(core::all_names<cave_drawing::Paper>()))
      ->capture_default_str();
  command->add_option("--scale", args->scale, "Such as 1:500; default: the largest that fits the paper")
      ->check(not_empty());
  command
      ->add_option(
          "--bearing", args->bearing_deg,
          "Of the projected profile, to its right, degrees clockwise from grid north; default: along "
          "the greatest extent")
      ->check(number_in(-360, 360));
  command
      ->add_option("--declination", args->declination_deg,
                   "Of the grid's north, degrees east of true north; the arrow shows true north")
      ->check(number_in(-180, 180))
      ->capture_default_str();
  command
      ->add_option("--entrance", args->entrance,
                   "\"x y z\" in a map, m: where heights are zero; default: where the flight began")
      ->check(not_empty());
  command->add_option("--name", args->name, "Name in the title block; default: that of the cave")
      ->check(not_empty());
  command->add_option("--date", args->date, "Date in the title block, as it is to be printed")
      ->check(not_empty());
  command->add_flag("--force", args->force, "Overwrite drawings that are there");
  command->footer(
      "Examples:\n  karst draw runs/demo --out drawings/demo\n"
      "  karst draw runs/demo --out drawings/demo --paper a3 --scale 1:250 --bearing 60\n"
      "  karst draw cave.svx --out drawings/cave");
  command->callback([args] { write_drawings(*args); });
}

}  // namespace karst::tools
