#include "sdk/tools/map_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core_stack/common/error.h"
#include "core_stack/common/install_location.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/rounded.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/map_merge/icp.h"
#include "sdk/map_merge/map_inputs.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;
using core::to_millionths;
using nlohmann::ordered_json;

constexpr int kNotMerged = 2;  // exit code: inputs were read, but cannot be merged

struct MergeArguments {
  std::vector<std::string> maps, settings;
  std::string out;
  double resolution_m = 0.2;
  bool six = false, json = false, force = false;
};

struct Placed {
  const map_merge::MapInput* map;
  map_merge::MapRegistration registration;
};

ordered_json json_of(const Placed& p) {
  const map_merge::MapRegistration& r = p.registration;
  const Eigen::Matrix3d R = r.T_target_source.orientation.toRotationMatrix();
  ordered_json rows = ordered_json::array();
  for (int i = 0; i < 3; ++i)
    rows.push_back({to_millionths(R(i, 0)), to_millionths(R(i, 1)), to_millionths(R(i, 2)),
                    to_millionths(r.T_target_source.position[i])});
  rows.push_back({0, 0, 0, 1});
  return {{"map", p.map->name},
          {"file", p.map->file},
          {"trusted", r.trusted},
          {"reason", r.reason},
          {"T_first_map", rows},
          {"residual_m", to_millionths(r.overlay.residual_m())},
          {"overlap_of_map", to_millionths(r.overlay.source_overlap())},
          {"overlap_of_rest", to_millionths(r.overlay.target_overlap())},
          {"shared_m2", to_millionths(r.shared_m2)},
          {"agreement", to_millionths(r.overlay.agreement())},
          {"hold", to_millionths(r.hold)},
          {"rival", to_millionths(r.rival)}};
}

map_merge::MapRegistrationOptions options_of(const MergeArguments& args) {
  map_merge::MapRegistrationOptions options;
  options.coarse.gravity_known = !args.six;
  core::OptionTable table;
  describe(table, options.limits);
  for (const std::string& s : args.settings) {
    const auto equals = s.find('=');
    if (equals == std::string::npos)
      throw core::InputError("--set", s, "expected key=value, such as min_overlap=0.2");
    table.set("--set", s.substr(0, equals), s.substr(equals + 1));
  }
  return options;
}

std::string stem_of(const std::string& out) {
  const std::string ending = fs::path(out).extension().string();
  return ending == ".bt" || ending == ".ot" || ending == ".ply" ? out.substr(0, out.size() - ending.size())
                                                                : out;
}

std::vector<map_merge::MapInput> read_all(const MergeArguments& args) {
  std::vector<map_merge::MapInput> maps;
  for (const std::string& name : args.maps) {
    maps.push_back(map_merge::read_map_input(name, args.resolution_m));
    const map_merge::MapInput &first = maps.front(), &last = maps.back();
    if (first.piece.cells && last.piece.cells &&
        std::abs(first.piece.resolution_m / last.piece.resolution_m - 1) > 0.01)
      throw core::InputError(last.file, "res",
                             "cells of " + std::to_string(last.piece.resolution_m) +
                                 " m cannot be added to those of " +
                                 std::to_string(first.piece.resolution_m) + " m in " + first.file);
  }
  return maps;
}

/// Registers each map in the merged map so far; one that does not fit is tried again after others have been
/// added.
std::vector<Placed> place_all(const std::vector<map_merge::MapInput>& maps,
                              const map_merge::MapRegistrationOptions& options,
                              map_merge::MergedMap& merged) {
  std::vector<Placed> placed;
  std::vector<const map_merge::MapInput*> waiting;
  for (std::size_t i = 1; i < maps.size(); ++i) waiting.push_back(&maps[i]);
  while (!waiting.empty()) {
    std::vector<Placed> refused;
    for (const map_merge::MapInput* map : waiting) {
      print_error("registering %s ...\n", map->name.c_str());
      const Placed p{map, map_merge::register_maps(merged.piece(), map->piece, options)};
      if (p.registration.trusted) {
        merged.add(*map, p.registration.T_target_source);
        placed.push_back(p);
      } else {
        refused.push_back(p);
      }
    }
    if (refused.size() == waiting.size()) {
      placed.insert(placed.end(), refused.begin(), refused.end());
      break;
    }
    waiting.clear();
    for (const Placed& p : refused) waiting.push_back(p.map);
  }
  return placed;
}

void print(const Placed& p) {
  const map_merge::MapRegistration& r = p.registration;
  const core::Vec3& t = r.T_target_source.position;
  print_wrapped(stdout, 2, "%s: %s\n", p.map->name.c_str(),
                r.trusted ? "in place" : ("refused: " + r.reason).c_str());
  print_out("  moved by (%.2f, %.2f, %.2f) m, turned by %.2f deg%s\n", t.x(), t.y(), t.z(),
            core::heading_of(r.T_target_source.orientation) * 180 / std::numbers::pi,
            r.trusted ? "" : " at best");
  print_out("  residual %.3f m, overlap %.0f %% of it and %.0f %% of the rest (%.0f m^2)\n",
            r.overlay.residual_m(), 100 * r.overlay.source_overlap(), 100 * r.overlay.target_overlap(),
            r.shared_m2);
  print_out("  agreement %.1f %%, hold %.3f, next best pose %.0f %% as good\n", 100 * r.overlay.agreement(),
            r.hold, 100 * r.rival);
}

/// Checks before minutes of registration that the output can be written.
void check_can_write(const std::string& stem) {
  const fs::path parent = fs::absolute(stem).parent_path();
  std::error_code error;
  fs::create_directories(parent, error);
  if (error) throw core::InputError(parent.string(), "", "cannot be made: " + error.message());
  if (::access(parent.c_str(), W_OK) != 0)
    throw core::InputError(parent.string(), "", std::string("cannot be written to: ") + std::strerror(errno));
}

int merge(const MergeArguments& args) {
  if (!map_merge::has_icp())
    throw std::runtime_error("this karst was built without PCL: apt-get install libpcl-dev and build again");
  const map_merge::MapRegistrationOptions options = options_of(args);
  const std::string stem = stem_of(args.out);
  if (!args.force)
    for (const char* ending : {".ot", ".bt", ".ply", ".json"})
      if (fs::exists(stem + ending))
        throw core::InputError(stem + ending, "", "is there already; choose another --out, or --force");
  check_can_write(stem);
  const std::vector<map_merge::MapInput> maps = read_all(args);
  map_merge::MergedMap merged(maps.front());
  const std::vector<Placed> placed = place_all(maps, options, merged);
  const bool all =
      std::all_of(placed.begin(), placed.end(), [](const Placed& p) { return p.registration.trusted; });

  ordered_json report{{"schema", "karst.merge/1"}, {"first", maps.front().name}, {"merged", all}};
  report["maps"] = ordered_json::array();
  for (const Placed& p : placed) report["maps"].push_back(json_of(p));
  std::vector<fs::path> files;
  if (all) {
    files = merged.write(stem);
    evaluation::write_whole_file(stem + ".json", core::json_text(report, 2) + "\n");
  }
  if (args.json) {
    print_json(report);
  } else {
    for (const Placed& p : placed) print(p);
    for (const fs::path& f : files) print_out("%s\n", f.c_str());
  }
  if (!all) print_error("karst: not all maps could be put together; nothing was written\n");
  return all ? 0 : kNotMerged;
}

}  // namespace

void add_map_command(CLI::App& app) {
  CLI::App* map = app.add_subcommand("map", "Put maps of several flights together");
  map->require_subcommand(1);
  auto args = std::make_shared<MergeArguments>();
  CLI::App* command = map->add_subcommand(
      "merge",
      "Put maps of several flights together, in the frame of the first\n\n"
      "  karst map merge runs/monday runs/tuesday --out maps/cave\n"
      "  karst map merge a.bt b.ot c.ot --out all --json\n"
      "  karst map merge scan1.ply scan2.pcd --six --out both\n\n"
      "A registration that cannot be trusted is refused with the reason, and then nothing is written.\n"
      "Exit code: 0 merged, 2 refused, 1 an error.");
  command->add_option("maps", args->maps, "run directories, OctoMap files (.bt, .ot) or clouds (.ply, .pcd)")
      ->type_name(kFile)
      ->required()
      ->expected(2, 1000);
  command->add_option("--out,-o", args->out, "path without ending: writes .ot, .bt, .ply and .json")
      ->type_name(kFile)
      ->required()
      ->check(not_empty());
  command->add_flag("--six", args->six, "the maps' z axes need not point up");
  command->add_option("--resolution", args->resolution_m, "metres to which clouds are thinned out")
      ->capture_default_str()
      ->check(number_in(0.05, 1.0));
  command->add_option("--set", args->settings, "limit=value; see " + core::doc_path("docs/map_merge.md"))
      ->allow_extra_args(false);
  command->add_flag("--json", args->json, "print the report as JSON");
  command->add_flag("--force", args->force, "overwrite");
  command->callback([args] {
    if (const int code = merge(*args); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace karst::tools
