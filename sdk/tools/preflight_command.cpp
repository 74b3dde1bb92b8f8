#include "sdk/tools/preflight_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/info_reader.h"
#include "core_stack/common/install_location.h"
#include "core_stack/common/shell_word.h"
#include "core_stack/vehicle/load_vehicle.h"
#include "plugins/simulator/simulator_options.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/flight/auto_policy.h"
#include "sdk/flight/known_map.h"
#include "sdk/flight/mission_file.h"
#include "sdk/host/plugin/selection.h"
#include "sdk/preflight/look.h"
#include "sdk/preflight/preflight_json.h"
#include "sdk/preflight/preflight_page.h"
#include "sdk/preflight/preflight_words.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"
#include "sdk/tools/mesh_options.h"
#include "sdk/tools/vehicle_preflight.h"

namespace karst::tools {
namespace {

using core::InputError;

constexpr int kNoGo = 3;  // exit code
constexpr const char *kVehicleKey = "simulator.vehicle", *kBatteryKey = "simulator.battery_minutes";

struct PreflightArguments {
  flight::MissionOverrides overrides;
  std::string mission_file;  // "": overrides.cave is checked
  std::string vehicle, battery, page;
  preflight::LookOptions look;
  MeshOptions mesh;
  VehiclePreflightArguments real;  // of a vehicle plugin; only its own options are set
  bool json = false, quiet = false;
};

/// Of a terminal; a file or a pipe gets lines of a length that can be read, too.
std::size_t text_columns() {
  constexpr std::size_t kColumnsOfAFile = 100;
  const std::size_t columns = terminal_columns(stdout);
  return columns > 0 ? columns : kColumnsOfAFile;
}

/// Adds a setting for which there is an option of its own.
void add_setting(flight::MissionOverrides& overrides, const char* option, const std::string& key,
                 const std::string& value) {
  if (value.empty()) return;
  for (const std::string& s : overrides.settings)
    if (s.starts_with(key + "="))
      throw InputError("--set", key, std::string("is given by ") + option + " as well");
  overrides.values.emplace_back(key, value);
}

flight::Mission mission_of(const PreflightArguments& args) {
  flight::MissionOverrides overrides = args.overrides;
  add_setting(overrides, "--vehicle", kVehicleKey, args.vehicle);
  add_setting(overrides, "--battery", kBatteryKey, args.battery);
  for (const auto& [key, value] : args.mesh) overrides.values.emplace_back("cave." + key, value);
  return flight::with_earlier_map(flight::read_mission(args.mission_file, overrides));
}

/// A file of a mission, and not of a cave, has one of these sections.
bool is_mission_file(const std::string& path) {
  if (!path.ends_with(".info") || !std::filesystem::is_regular_file(path)) return false;
  const auto tree = core::read_including_info(path);
  return tree.count("cave") + tree.count("vehicle") + tree.count("policy") + tree.count("mission") > 0;
}

/// Flies what was judged: the policy and its parameters by name, so that nothing is selected again.
std::string fly_command(const PreflightArguments& args, const preflight::PolicyFacts& policy) {
  std::string command = "karst fly";
  if (!args.mission_file.empty()) command += " " + core::shell_word(args.mission_file);
  const auto add = [&command](const std::string& option, const std::string& value) {
    command += core::shell_option(option, value);
  };
  const auto set = [&add](const std::string& key, const std::string& value) {
    if (!value.empty()) add("--set", key + "=" + value);
  };
  add("--cave", args.overrides.cave);
  add("--start", args.overrides.start);
  for (const auto& [key, value] : args.mesh) add("--" + key, value);
  for (const std::string& plugin : args.look.plugins) add("--plugin", plugin);
  add("--policy", policy.policy);
  set(kVehicleKey, args.vehicle);
  set(kBatteryKey, args.battery);
  for (const std::string& setting : args.overrides.settings) add("--set", setting);
  for (const auto& [key, value] : policy.changed) set("policy.parameters." + key, value);
  return command;
}

/// `--vehicle` or the mission names a vehicle plugin.
int run_of_vehicle(const PreflightArguments& args) {
  VehiclePreflightArguments real = args.real;
  real.mission_file = args.mission_file;
  real.overrides = args.overrides;
  add_setting(real.overrides, "--vehicle", "vehicle", args.vehicle);
  real.plugins = args.look.plugins;
  real.page = args.page;
  real.json = args.json;
  real.quiet = args.quiet;
  return vehicle_preflight(real) ? 0 : kNoGo;
}

/// A vehicle that is simulated, or a plugin. Throws InputError naming what there is.
void check_vehicle(const std::string& name) {
  const std::vector<std::string> simulated = core::all_names<sim::VehiclePreset>();
  if (name.empty() || is_vehicle(name) || std::count(simulated.begin(), simulated.end(), name) > 0) return;
  const auto list = [](const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& n : names) text += (text.empty() ? "" : ", ") + n;
    return text;
  };
  throw InputError("karst preflight", "--vehicle",
                   "no vehicle \"" + name + "\" here; there is: " + list(simulated) +
                       " (simulator.vehicle); and to listen to, the plugins " +
                       list(core::vehicles_in(core::plugin_root() / "vehicles")));
}

int run(const PreflightArguments& args) {
  if (args.overrides.cave.empty() && args.mission_file.empty())
    throw InputError("karst preflight", "",
                     "argument cave is missing, or --vehicle with the name of a vehicle plugin; "
                     "`karst preflight --help` says more");
  const flight::Mission mission = mission_of(args);
  preflight::LookOptions look = args.look;
  if (!args.quiet && !args.json)
    look.tell = [](const std::string& message) { print_wrapped(stderr, 2, "%s\n", message.c_str()); };
  const preflight::Preflight known = preflight::look_at(mission, look);
  const std::vector<preflight::Finding> findings = preflight::findings_of(known);
  if (!args.page.empty()) evaluation::write_whole_file(args.page, preflight::preflight_page(known, findings));
  if (args.json) {
    print_json(preflight::to_json(known, findings));
  } else {
    const std::size_t columns = text_columns();
    print_out("%s", wrapped(preflight::findings_text(known, findings), columns, 4).c_str());
    print_out("%s", wrapped(preflight::facts_text(known), columns, preflight::kNameColumns).c_str());
    if (known.policy && preflight::is_go(findings))  // in one line, to be copied
      print_out("Fly it:\n  %s\n", fly_command(args, *known.policy).c_str());
  }
  return preflight::is_go(findings) ? 0 : kNoGo;
}

/// For the --vehicle of a plugin.
void add_listening_options(CLI::App& app, VehiclePreflightArguments& real) {
  app.add_option("--seconds", real.rest_s,
                 "of a vehicle plugin: how long it is listened to while it stands, s")
      ->check(number_in(3, 600))
      ->capture_default_str();
  app.add_flag("--motion", real.motion,
               "of a vehicle plugin: then turn it by hand, for the mounting and the delay of the LiDAR, and "
               "the compass");
  app.add_option("--motion-seconds", real.motion_s, "how long it is turned, s")
      ->check(number_in(10, 120))
      ->capture_default_str();
  app.add_flag("--real-time", real.real_time,
               "of a vehicle plugin: by the computer's clock, as all but simulators need");
  app.add_option("--out", real.run_folder,
                 "of a vehicle plugin: where its flight will be recorded, to check the space there")
      ->type_name(kFolder)
      ->check(not_empty())
      ->capture_default_str();
}

}  // namespace

void add_preflight_command(CLI::App& app) {
  auto args = std::make_shared<PreflightArguments>();
  args->overrides.policy = flight::kAutoPolicy;
  CLI::App* preflight_app = app.add_subcommand(
      "preflight",
      "Say go or no-go for a mission: cave, battery, vehicle, policy, time of return\n\n"
      "  karst preflight caves/demo.info --battery \"8 min\"\n"
      "  karst preflight scan.ply --start \"1 2 1.5\" --policy nearest_frontier --page preflight.html\n"
      "  karst preflight --vehicle mavlink mission.info --real-time --motion --page checklist.html\n\n"
      "The last one listens to a real vehicle and checks its sensors, without a command to it. Nothing is "
      "flown. What is said, and by which rules: " +
          core::doc_path("docs/preflight.md") + ".\n\nExit code: 0 go, 3 no-go, 1 an error.");
  preflight_app
      ->add_option(
          "cave", args->overrides.cave,
          "cave .info file or mesh (STL, PLY, OBJ, DAE), or a mission file, which names cave or vehicle")
      ->type_name(kFile)
      ->check(not_empty());
  preflight_app
      ->add_option("--start", args->overrides.start, "\"x y z [heading_deg]\" above the floor to start from")
      ->check(not_empty());
  add_mesh_options(*preflight_app, args->mesh);
  preflight_app
      ->add_option(
          "--vehicle", args->vehicle,
          "what the vehicle carries: lidar_uav, lidar_only_uav or camera_uav (simulator.vehicle); or a "
          "vehicle plugin such as mavlink: the vehicle itself is checked")
      ->check(not_empty());
  preflight_app
      ->add_option("--battery", args->battery,
                   "hovering time of a full battery, such as \"8 min\" (simulator.battery_minutes)")
      ->check(not_empty());
  preflight_app
      ->add_option("--policy", args->overrides.policy,
                   "exploration policy; see karst policy list; auto: selected for the cave")
      ->type_name(kPolicy)
      ->check(not_empty())
      ->capture_default_str();
  preflight_app
      ->add_option("--plugin", args->look.plugins, "file with policies (.so or .py) to look in first")
      ->type_name(kFile)
      ->allow_extra_args(false)
      ->check(not_empty());
  preflight_app
      ->add_option("--results", args->look.results,
                   "stores of campaigns, experiences; default: what is installed")
      ->type_name(kFile)
      ->allow_extra_args(false)
      ->check(not_empty());
  preflight_app->add_option("--set", args->overrides.settings, "key=value of a mission; see karst fly --keys")
      ->type_name(kSetting)
      ->allow_extra_args(false);
  preflight_app->add_option("--page", args->page, "write the summary as a page to print, an HTML file")
      ->type_name(kFile)
      ->check(not_empty());
  add_listening_options(*preflight_app, args->real);
  preflight_app->add_flag("--json", args->json, "Write JSON");
  preflight_app->add_flag("--quiet", args->quiet, "no progress on standard error");
  preflight_app->callback([args, preflight_app] {
    host::take_policy_file(args->overrides.policy, args->look.plugins);
    check_vehicle(args->vehicle);
    flight::MissionOverrides& overrides = args->overrides;
    const bool plugin_named = is_vehicle(args->vehicle);
    if (plugin_named || is_mission_file(overrides.cave))
      args->mission_file = std::exchange(overrides.cave, "");
    // A mission has its own policy.
    if ((plugin_named || !args->mission_file.empty()) && preflight_app->count("--policy") == 0)
      overrides.policy.clear();
    const bool listens =
        plugin_named ||
        (!args->mission_file.empty() && flight::named_vehicle(args->mission_file, overrides) != "simulator");
    const int code = listens ? run_of_vehicle(*args) : run(*args);
    if (code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace karst::tools
