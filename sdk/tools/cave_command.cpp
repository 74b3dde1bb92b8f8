#include "sdk/tools/cave_command.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/json_point.h"
#include "core_stack/common/output_file.h"
#include "plugins/simulator/cave/boundary_loops.h"
#include "plugins/simulator/cave/cave.h"
#include "plugins/simulator/cave/mesh_advice.h"
#include "plugins/simulator/cave/propose_start.h"
#include "plugins/simulator/cave/remedies.h"
#include "plugins/simulator/cave_generator/generate_cave.h"
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
  bool force = false;
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
  const cave::GeneratedCave cave = cave::generate_cave(
      recipe, args.seed, [&](const char* step, double fraction) { progress(step, fraction); });
  cave::write_mesh(files.mesh, cave.mesh);
  write_info(files.info, files.mesh_name, cave, recipe, args);
  progress("measuring", 0.9);
  const evaluation::Reachable r = evaluation::find_reachable(cave.mesh, cave.start.position, {}, files.mesh);
  progress.end();

  double length_m = 0;
  for (const auto& points : cave.axes)
    for (std::size_t i = 1; i < points.size(); ++i) length_m += (points[i] - points[i - 1]).norm();
  const selection::MeshFacts facts = selection::mesh_facts(cave.mesh);
  const Vec3 extent = facts.high - facts.low;
  print_out("%s: %.0f m3, %.0f x %.0f x %.0f m, %zu passages of %.0f m together\n", files.info.c_str(),
            cave.volume_m3, extent.x(), extent.y(), extent.z(), cave.axes.size(), length_m);
  print_out("  %zu triangles; %zu fallen blocks, %zu speleothems\n", facts.triangles, cave.boulders,
            cave.speleothems);
  print_out("  on the map's grid: %.0f m3 to explore, %.0f m3 of it at least %.1f m from rock\n",
            r.volume_m3(), r.flyable_volume_m3(), r.options.clearance_m);
  print_out("next:\n  karst fly --cave %s --policy nearest_frontier\n  karst cave info %s\n",
            files.info.c_str(), files.info.c_str());
}

/// Facts that need no start.
struct MeshReport {
  selection::MeshFacts facts;
  cave::MeshFrame frame;
  std::vector<cave::MeshAdvice> advice;
  std::size_t holes = 0;  // loops of open edges
};

MeshReport report_of(const cave::RayScene& scene, const cave::MeshFrame& frame) {
  return {selection::mesh_facts(scene.mesh()), frame, cave::mesh_advice(cave::shape_of(scene), frame),
          cave::boundary_loops(scene.mesh()).size()};
}

void print_mesh(const InfoArguments& args, const MeshReport& report) {
  const selection::MeshFacts& m = report.facts;
  const Vec3 e = m.high - m.low;
  print_out("%s\n", args.file.c_str());
  print_out("  triangles          %zu\n", m.triangles);
  print_out("  extent             %.1f x %.1f x %.1f m, heights %.1f to %.1f m\n", e.x(), e.y(), e.z(),
            m.low.z(), m.high.z());
  if (m.odd_edges == 0)
    print_out("  closed             yes, every edge joins two triangles that face the same side\n");
  else
    print_out("  closed             no, %zu of %zu edges do not join two triangles that face the same side\n",
              m.odd_edges, m.edges);
  if (report.holes > 0)
    print_out("  open edges         %s; --cap OUT.ply closes holes\n",
              core::counted(report.holes, "loop").c_str());
  if (!cave::is_plain(report.frame))
    print_out("  read as            %s\n", cave::to_text(report.frame).c_str());
  for (const cave::MeshAdvice& a : report.advice)
    print_out("  check              %s: %s\n", a.finding.c_str(), a.remedy.c_str());
}

ordered_json json_of(const InfoArguments& args, const MeshReport& report) {
  const selection::MeshFacts& m = report.facts;
  ordered_json j{{"file", args.file},          {"triangles", m.triangles},
                 {"low_m", core::list(m.low)}, {"high_m", core::list(m.high)},
                 {"closed", m.odd_edges == 0}, {"edges", m.edges},
                 {"odd_edges", m.odd_edges},   {"open_loops", report.holes}};
  j["advice"] = ordered_json::array();
  for (const cave::MeshAdvice& a : report.advice)
    j["advice"].push_back({{"finding", a.finding}, {"remedy", a.remedy}});
  return j;
}

/// Of a cave without a start: its shape, and a start that suits.
void info_without_start(const InfoArguments& args, const core::MeshKeys& keys) {
  const cave::MeshFile mesh = cave::mesh_of(args.file, keys);
  const cave::RayScene scene(cave::load_mesh(mesh));
  const MeshReport report = report_of(scene, mesh.frame);
  std::optional<cave::StartPose> suits;
  if (report.advice.empty())
    suits = cave::propose_start(scene);  // in another frame it would be another place
  if (args.json) {
    ordered_json j = json_of(args, report);
    j["proposed_start"] = suits ? ordered_json(cave::start_text(*suits)) : ordered_json();
    print_json(j);
    return;
  }
  print_mesh(args, report);
  if (suits)
    print_out("  start              none given; one that suits: --start \"%s\"\n",
              cave::start_text(*suits).c_str());
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
  const MeshReport report = report_of(cave.scene, cave.description.mesh_frame);
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
  print_out("  start              %.2f %.2f %.2f, %.2f m from rock\n", start.x(), start.y(), start.z(),
            clearance_m);
  print_out("  free volume        %.0f m3, connected to the start, in cells of %g m\n", r.free_volume_m3(),
            r.options.resolution_m);
  print_out("  reachable volume   %.0f m3, what coverage is measured by\n", r.volume_m3());
  print_out("  fly-through volume %.0f m3, at least %g m from rock, heights %.1f to %.1f m\n",
            r.flyable_volume_m3(), r.options.clearance_m, lowest, highest);
  print_out("  width there        %.1f m; %.1f m and %.1f m at the 10th and 90th percentile\n",
            passages.width_m[1], passages.width_m[0], passages.width_m[2]);
  print_out("  height there       %.1f m; %.1f m and %.1f m\n", passages.height_m[1], passages.height_m[0],
            passages.height_m[2]);
}

std::string generate_footer() {
  cave::CaveRecipe recipe;
  core::OptionTable table;
  describe(table, recipe);
  std::string presets;
  for (const std::string& name : cave::cave_presets()) {
    const cave::CaveRecipe r = cave::cave_preset(name);
    presets += core::format_text(
        "  %-9s %6.0f m3, passages about %.1f m wide, %d loops, %d domes, %d shafts, %d chimneys\n",
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

}  // namespace

CLI::App& add_cave_command(CLI::App& app) {
  CLI::App* cave = app.add_subcommand("cave", "Make caves, and say what a cave is like");
  cave->require_subcommand(1);

  auto g = std::make_shared<GenerateArguments>();
  CLI::App* make = cave->add_subcommand("generate", "Make a cave: writes OUT.ply and OUT.info");
  make->add_option("--preset", g->preset, "The kind of cave to start from")->capture_default_str();
  make->add_option("--seed", g->seed, "Another seed, another cave of the kind")
      ->check(whole_64_bits())
      ->capture_default_str();
  make->add_option("--out,-o", g->out, "Path of the cave without ending, such as caves/demo")
      ->type_name(kFile)
      ->required()
      ->check(not_empty());
  make->add_option("--set", g->set, "A value of the recipe, key=value; any number of these")
      ->allow_extra_args(false);
  make->add_option("--format", g->format, "Of the mesh")
      ->check(CLI::IsMember({"ply", "stl"}))
      ->capture_default_str();
  make->add_flag("--force", g->force, "Overwrite a cave that is there");
  make->footer(generate_footer);
  make->callback([g] { generate(*g); });

  auto i = std::make_shared<InfoArguments>();
  CLI::App* tell = cave->add_subcommand("info", "Size, start, clearance and reachable volume of a cave");
  tell->add_option("file", i->file, "A cave's .info file, or a mesh")->type_name(kFile)->required();
  tell->add_option("--start", i->start, "\"x y z\", for a mesh or instead of the file's own")
      ->check(not_empty());
  tell->add_option("--resolution", i->options.resolution_m, "Edge of the map's cells, m")
      ->check(number_in(0.05, 1.0))
      ->capture_default_str();
  tell->add_option("--clearance", i->options.clearance_m, "Least distance to rock when flying, m")
      ->check(number_in(0.05, 5.0))
      ->capture_default_str();
  add_mesh_options(*tell, i->mesh);
  tell->add_option("--cap", i->cap.out,
                   "Close the holes and write the mesh, in metres with z up, to this new .ply or .stl file")
      ->type_name(kFile)
      ->check(not_empty());
  tell->add_option("--cap-limit", i->cap.limit_m, "Holes that are wider stay open, m")
      ->check(number_in(0.01, 1000))
      ->capture_default_str();
  tell->add_flag("--json", i->json, "Write JSON");
  tell->footer(
      "Examples:\n  karst cave info tunnel.stl --start \"1 2 1.5\"\n"
      "  karst cave info scan.obj --unit mm --up y\n"
      "  karst cave info tunnel.stl --cap closed.ply");
  tell->callback([i] { info(*i); });
  return *cave;
}

}  // namespace karst::tools
