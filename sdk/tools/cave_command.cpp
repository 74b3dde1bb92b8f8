#include "sdk/tools/cave_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "core_stack/common/counted.h"
#include "core_stack/common/decimal_text.h"
#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/json_point.h"
#include "core_stack/common/output_file.h"
#include "plugins/simulator/cave/boundary_loops.h"
#include "plugins/simulator/cave/cave.h"
#include "plugins/simulator/cave/mesh_advice.h"
#include "plugins/simulator/cave/preflight.h"
#include "plugins/simulator/cave/propose_start.h"
#include "plugins/simulator/cave/remedies.h"
#include "plugins/simulator/cave_generator/generate_cave.h"
#include "sdk/evaluation/reachable/reachable.h"
#include "sdk/selection/cave_facts.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"
#include "sdk/tools/cave_cap.h"
#include "sdk/tools/cave_files.h"
#include "sdk/tools/mesh_options.h"
#include "sdk/tools/step_progress.h"

namespace karst::tools {
namespace {

using core::InputError;
using core::Vec3;
using nlohmann::ordered_json;

struct GenerateArguments {
  std::string preset = "small", out, format = "ply";
  std::vector<std::string> set;
  std::uint64_t seed = 1;
  bool force = false, quiet = false;
};

struct InfoArguments {
  std::string file, start;
  MeshOptions mesh;
  CapArguments cap;
  bool json = false;
  evaluation::ReachableOptions options;
};

cave::CaveRecipe recipe_of(const GenerateArguments& args) {
  cave::CaveRecipe recipe = cave::cave_preset(args.preset);
  core::OptionTable table;
  describe(table, recipe);
  for (const std::string& s : args.set) {
    const auto equals = s.find('=');
    if (equals == std::string::npos) throw InputError("--set", s, "expected key=value, such as volume=2500");
    table.set("--set", s.substr(0, equals), s.substr(equals + 1));
  }
  return recipe;
}

void write_info(const std::string& path, const std::string& mesh, const cave::GeneratedCave& cave,
                cave::CaveRecipe recipe, const GenerateArguments& args) {
  std::ofstream out = core::open_output(path);
  out << "; made by: karst cave generate --preset " << args.preset << " --seed " << args.seed;
  for (const std::string& s : args.set) out << " --set \"" << s << "\"";
  out << "\n; recipe:\n";
  core::OptionTable table;
  describe(table, recipe);
  for (const auto& row : table.rows()) out << ";   " << row.key << " = " << core::value_text(row) << "\n";
  const Vec3& p = cave.start.position;
  out << "mesh \"" << mesh << "\"\n"
      << "start \""
      << core::format_text("%g %g %g %.1f", p.x(), p.y(), p.z(),
                           cave.start.heading_rad * 180 / std::numbers::pi)
      << "\"\nreflectivity 0.5\n";
  out.flush();
  if (!out) throw InputError(path, "", "cannot be written");
}

void generate(const GenerateArguments& args) {
  const cave::CaveRecipe recipe = recipe_of(args);
  const CaveFiles files = new_cave_files(args.out, args.format, args.force);
  StepProgress progress;
  const auto show = [&](const char* step, double fraction) {
    if (!args.quiet) progress(step, fraction);
  };
  const cave::GeneratedCave cave = cave::generate_cave(recipe, args.seed, show);
  cave::write_mesh(files.mesh, cave.mesh);
  write_info(files.info, files.mesh_name, cave, recipe, args);
  if (args.quiet) return;
  show("measuring the volume to explore", 0.9);
  const evaluation::Reachable r = evaluation::find_reachable(cave.mesh, cave.start.position, {}, files.mesh);
  progress.end();

  double length_m = 0;
  for (const auto& points : cave.axes)
    for (std::size_t i = 1; i < points.size(); ++i) length_m += (points[i] - points[i - 1]).norm();
  const selection::MeshFacts facts = selection::mesh_facts(cave.mesh);
  const Vec3 extent = facts.high - facts.low;
  print_out("%s: %.0f m³, %.0f x %.0f x %.0f m, %zu passages of %.0f m together\n", files.info.c_str(),
            cave.volume_m3, extent.x(), extent.y(), extent.z(), cave.axes.size(), length_m);
  print_out("  %zu triangles; %zu fallen blocks, %zu speleothems\n", facts.triangles, cave.boulders,
            cave.speleothems);
  print_out("  on the map's grid: %.0f m³ to explore, %.0f m³ of it at least %.1f m from rock\n",
            r.volume_m3(), r.flyable_volume_m3(), r.options.clearance_m);
  print_out("next:\n  karst fly --cave %s --policy nearest_frontier\n  karst cave info %s\n",
            files.info.c_str(), files.info.c_str());
}

/// Facts that need no start.
struct MeshReport {
  selection::MeshFacts facts;
  cave::MeshFrame frame;
  std::vector<cave::MeshAdvice> advice;
  std::string axis_hint;
  std::vector<cave::BoundaryLoop> loops;  // of open edges, the largest first
};

MeshReport report_of(const InfoArguments& args, const cave::RayScene& scene, const cave::MeshFrame& frame) {
  const cave::MeshShape shape = cave::shape_of(scene);
  const bool axis_given = std::any_of(args.mesh.begin(), args.mesh.end(),
                                      [](const auto& key_value) { return key_value.first == "up"; });
  return {selection::mesh_facts(scene.mesh()), frame, cave::mesh_advice(shape, frame),
          axis_given ? "" : cave::axis_hint(shape, frame), cave::boundary_loops(scene.mesh())};
}

/// The unit that the size was read in, and what changes it: nothing tells feet from metres but the size.
std::string unit_note(const cave::MeshFrame& frame) {
  const std::string key = frame.states_its_own ? "scale" : "unit";
  const std::string unit =
      frame.states_its_own && frame.metres_per_unit == 1 ? "the file's own" : cave::unit_text(frame);
  return "unit: " + unit + (frame.given_as_options ? "; --" + key : "; the key " + key) + " changes it";
}

void print_open_edges(const std::vector<cave::BoundaryLoop>& loops) {
  constexpr std::size_t kShown = 10;
  if (loops.empty()) return;
  print_out("  open edges         %s; `karst cave info CAVE --cap OUT.ply` closes holes\n",
            core::counted(loops.size(), "loop").c_str());
  for (std::size_t i = 0; i < loops.size() && i < kShown; ++i)
    print_out("                     %s\n", cave::size_and_place(loops[i]).c_str());
  if (loops.size() > kShown)
    print_out("                     and %zu smaller ones; --json lists all\n", loops.size() - kShown);
}

std::string closed_text(const selection::MeshFacts& m) {
  const std::string flipped = core::counted(m.flipped_edges, "edge") +
                              (m.flipped_edges == 1 ? " joins" : " join") +
                              " triangles that face opposite sides; harmless";
  if (m.odd_edges == 0)
    return m.flipped_edges == 0 ? "yes, every edge joins two triangles that face the same side"
                                : "yes (" + flipped + ")";
  const std::string open =
      core::format_text("no, %zu of %zu edges do not join two triangles", m.odd_edges, m.edges);
  return m.flipped_edges == 0 ? open : open + " (" + flipped + ")";
}

void print_mesh(const InfoArguments& args, const MeshReport& report) {
  const selection::MeshFacts& m = report.facts;
  const Vec3 e = m.high - m.low;
  print_out("%s\n", args.file.c_str());
  print_out("  triangles          %zu\n", m.triangles);
  print_out("  extent             %.1f x %.1f x %.1f m (%s), heights %s to %s m\n", e.x(), e.y(), e.z(),
            unit_note(report.frame).c_str(), core::decimal_text(m.low.z(), 1).c_str(),
            core::decimal_text(m.high.z(), 1).c_str());
  print_out("  closed             %s\n", closed_text(m).c_str());
  print_open_edges(report.loops);
  if (!cave::is_plain(report.frame))
    print_out("  read as            %s\n", cave::to_text(report.frame).c_str());
  for (const cave::MeshAdvice& a : report.advice)
    print_out("  check              %s: %s\n", a.finding.c_str(), a.to_give.c_str());
  if (!report.axis_hint.empty()) print_out("  hint               %s\n", report.axis_hint.c_str());
}

ordered_json loop_json(const cave::BoundaryLoop& loop) {
  return {{"edges", loop.vertices.size()},
          {"area_m2", loop.area_m2},
          {"diameter_m", loop.diameter_m},
          {"centre_m", core::list(loop.centre)}};
}

ordered_json json_of(const InfoArguments& args, const MeshReport& report) {
  const selection::MeshFacts& m = report.facts;
  ordered_json j{{"file", args.file},
                 {"triangles", m.triangles},
                 {"low_m", core::list(m.low)},
                 {"high_m", core::list(m.high)},
                 {"closed", m.odd_edges == 0},
                 {"edges", m.edges},
                 {"odd_edges", m.odd_edges},
                 {"flipped_edges", m.flipped_edges},
                 {"open_loops", report.loops.size()}};
  j["open_edges"] = ordered_json::array();
  for (const cave::BoundaryLoop& loop : report.loops) j["open_edges"].push_back(loop_json(loop));
  j["advice"] = ordered_json::array();
  for (const cave::MeshAdvice& a : report.advice)
    j["advice"].push_back({{"finding", a.finding}, {"remedy", a.remedy}});
  j["axis_hint"] = report.axis_hint.empty() ? ordered_json() : ordered_json(report.axis_hint);
  return j;
}

/// Why a flight from there is refused; "" if it is not. A proposed start suits by what is around it, but the
/// mesh may be open elsewhere.
std::string refusal_at(const cave::RayScene& scene, const cave::MeshFile& mesh,
                       const cave::StartPose& start) {
  cave::CaveDescription description;
  description.file = description.mesh_path = mesh.path;
  description.start = start;
  try {
    cave::check_start({std::move(description), scene}, 0);
    evaluation::check_reachable(scene.mesh(), start.position, {}, mesh.path);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

void print_proposed(const cave::StartPose& start, const std::string& refusal) {
  const std::string text = cave::start_text(start);
  if (refusal.empty()) {
    print_out("  start              none given; one that suits: --start \"%s\"\n", text.c_str());
    return;
  }
  print_out("  start              none given; valid only after capping: --start \"%s\"\n", text.c_str());
  print_out("                     until then it is refused: %s\n", refusal.c_str());
}

/// Of a cave without a start: its shape, and a start that suits.
void info_without_start(const InfoArguments& args, const core::MeshKeys& keys) {
  const cave::MeshFile mesh = cave::mesh_of(args.file, keys);
  const cave::RayScene scene(cave::load_mesh(mesh));
  const MeshReport report = report_of(args, scene, mesh.frame);
  std::optional<cave::StartPose> suits;
  if (report.advice.empty())
    suits = cave::propose_start(scene);  // in another frame it would be another place
  const std::string refusal = suits && !report.loops.empty() ? refusal_at(scene, mesh, *suits) : "";
  if (args.json) {
    ordered_json j = json_of(args, report);
    j["proposed_start"] = suits ? ordered_json(cave::start_text(*suits)) : ordered_json();
    j["proposed_start_refused"] = refusal.empty() ? ordered_json() : ordered_json(refusal);
    print_json(j);
    return;
  }
  print_mesh(args, report);
  if (suits)
    print_proposed(*suits, refusal);
  else if (report.advice.empty())
    print_out("  start              none given, and none found that suits: give --start \"x y z\"\n");
  else
    print_out("  start              none given; one is proposed when unit, axis and origin are right\n");
}

/// Adds to a refusal what helps.
evaluation::Reachable reachable_of(const cave::Cave& cave, const evaluation::ReachableOptions& options) {
  const Vec3& start = cave.description.start.position;
  try {
    return evaluation::find_reachable(cave.scene.mesh(), start, options, cave.description.mesh_path);
  } catch (const InputError& e) {
    throw InputError(e, cave::remedies(cave.scene, cave.description.mesh_frame, start));
  }
}

void info(const InfoArguments& args) {
  const core::MeshKeys keys = mesh_keys_of(args.mesh);
  if (!args.cap.out.empty()) return write_capped(cave::mesh_of(args.file, keys), args.cap, args.json);
  if (args.start.empty() && !cave::has_start(args.file)) return info_without_start(args, keys);
  const cave::Cave cave = cave::load_cave(args.file, args.start, keys);
  const MeshReport report = report_of(args, cave.scene, cave.description.mesh_frame);
  const Vec3 start = cave.description.start.position;
  const double clearance_m = cave.scene.distance_to_rock(start, 100);
  const evaluation::Reachable r = reachable_of(cave, args.options);
  const selection::PassageFacts passages = selection::passage_facts(cave.scene, r);
  double lowest = 1e9, highest = -1e9;
  r.flyable.for_each([&](const core::CellKey& k) {
    const double z = (k.z + 0.5) * r.options.resolution_m;
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  });
  if (args.json) {
    ordered_json j = json_of(args, report);
    j["start"] = core::list(start);
    j["start_heading_rad"] = cave.description.start.heading_rad;
    j["start_clearance_m"] = clearance_m;
    j["resolution_m"] = r.options.resolution_m;
    j["clearance_m"] = r.options.clearance_m;
    j["free_volume_m3"] = r.free_volume_m3();
    j["reachable_volume_m3"] = r.volume_m3();
    j["fly_through_volume_m3"] = r.flyable_volume_m3();
    j["fly_through_heights_m"] = {lowest, highest};
    j["width_m_p10_p50_p90"] = passages.width_m;
    j["height_m_p10_p50_p90"] = passages.height_m;
    print_json(j);
    return;
  }
  print_mesh(args, report);
  print_out("  start              %s, %.2f m from rock\n", core::decimal_text(start, 2).c_str(), clearance_m);
  print_out("  free volume        %.0f m³: cells of %g m that no rock touches, connected to the start\n",
            r.free_volume_m3(), r.options.resolution_m);
  print_out(
      "  reachable volume   %.0f m³, by which coverage is measured: those of them flown through or seen\n",
      r.volume_m3());
  print_out("  flyable volume     %.0f m³: those of them at least %g m from rock, heights %s to %s m\n",
            r.flyable_volume_m3(), r.options.clearance_m, core::decimal_text(lowest, 1).c_str(),
            core::decimal_text(highest, 1).c_str());
  print_out(
      "  width there        %.1f m from wall to wall, median; %.1f m and %.1f m "
      "at the 10th and 90th percentile\n",
      passages.width_m[1], passages.width_m[0], passages.width_m[2]);
  print_out("  height there       %.1f m from floor to roof, median; %.1f m and %.1f m\n",
            passages.height_m[1], passages.height_m[0], passages.height_m[2]);
}

std::string generate_footer() {
  cave::CaveRecipe recipe;
  core::OptionTable table;
  describe(table, recipe);
  std::string presets;
  for (const std::string& name : cave::cave_presets()) {
    const cave::CaveRecipe r = cave::cave_preset(name);
    presets += core::format_text(
        "  %-9s %6.0f m³, passages about %.1f m wide, %d loops, %d domes, %d shafts, %d chimneys\n",
        name.c_str(), r.volume_m3, r.passage_width_m, static_cast<int>(r.loops), static_cast<int>(r.domes),
        static_cast<int>(r.shafts), static_cast<int>(r.chimneys));
  }
  return "Examples:\n"
         "  karst cave generate --preset small --seed 7 --out caves/demo\n"
         "  karst cave generate --preset maze --set volume=9000 --set \"passage_width=4 m\" --out "
         "caves/labyrinth\n\n"
         "Presets:\n" +
         presets + "\nKeys for --set, with the values of the preset medium:\n" + table.help() +
         "\nThe same preset, keys and seed give the same cave.";
}

/// As CLI11 writes choices. Those who name another one get the generator's own message.
std::string preset_choices() {
  std::string all;
  for (const std::string& name : cave::cave_presets()) all += (all.empty() ? "TEXT:{" : ",") + name;
  return all + "}";
}

}  // namespace

CLI::App& add_cave_command(CLI::App& app) {
  CLI::App* cave = app.add_subcommand("cave", "Make caves, and say what a cave is like");
  cave->require_subcommand(1);

  auto g = std::make_shared<GenerateArguments>();
  CLI::App* make = cave->add_subcommand("generate", "Make a cave: writes OUT.ply and OUT.info");
  make->add_option("--preset", g->preset, "the kind of cave to start from")
      ->type_name(preset_choices())
      ->capture_default_str();
  make->add_option("--seed", g->seed, "seed of the random numbers: another seed, another cave of the kind")
      ->check(whole_64_bits())
      ->capture_default_str();
  make->add_option("--out,-o", g->out, "path of the cave without ending, such as caves/demo")
      ->type_name(kFile)
      ->required()
      ->check(not_empty());
  make->add_option("--set", g->set, "a value of the recipe, key=value; any number of these")
      ->type_name(kSetting)
      ->allow_extra_args(false);
  make->add_option("--format", g->format, "file format of the mesh")
      ->check(CLI::IsMember({"ply", "stl"}))
      ->capture_default_str();
  make->add_flag("--force", g->force, "overwrite files that exist");
  make->add_flag("--quiet", g->quiet, "print nothing but errors: no progress, no facts about the cave");
  make->footer(generate_footer);
  make->callback([g] { generate(*g); });

  auto i = std::make_shared<InfoArguments>();
  CLI::App* tell =
      cave->add_subcommand("info", "Size, start, holes, clearance and reachable volume of a cave");
  tell->add_option("file", i->file, "a cave's .info file, or a mesh")->type_name(kFile)->required();
  tell->add_option("--start", i->start, "\"x y z\", m, for a mesh or instead of the file's own")
      ->check(not_empty());
  tell->add_option("--resolution", i->options.resolution_m, "edge of the map's cells, m")
      ->check(number_in(0.05, 1.0))
      ->capture_default_str();
  tell->add_option("--clearance", i->options.clearance_m, "least distance to rock when flying, m")
      ->check(number_in(0.05, 5.0))
      ->capture_default_str();
  add_mesh_options(*tell, i->mesh);
  tell->add_option("--cap", i->cap.out,
                   "close the holes and write the mesh, in metres with z up, to this new .ply or .stl file")
      ->type_name(kFile)
      ->check(not_empty());
  tell->add_option("--cap-limit", i->cap.limit_m, "diameter up to which holes are closed, m")
      ->check(number_in(0.01, 1000))
      ->capture_default_str();
  tell->add_flag("--json", i->json, "print JSON");
  tell->footer(
      "Examples:\n  karst cave info tunnel.stl --start \"1 2 1.5\"\n"
      "  karst cave info scan.obj --unit mm --up y\n"
      "  karst cave info tunnel.stl --cap closed.ply");
  tell->callback([i] { info(*i); });
  return *cave;
}

}  // namespace karst::tools
