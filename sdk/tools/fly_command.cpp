#include "sdk/tools/fly_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "core_stack/common/error.h"
#include "core_stack/common/stall_watch.h"
#include "sdk/host/hosted_policy.h"
#include "sdk/host/request_log.h"
#include "sdk/tools/arguments.h"
#include "sdk/tools/auto_policy.h"
#include "sdk/tools/cave_check.h"
#include "sdk/tools/fly_team.h"
#include "sdk/tools/interrupt.h"
#include "sdk/tools/mission_file.h"
#include "sdk/tools/report_command.h"
#include "sdk/tools/run_files.h"
#include "sdk/tools/status_line.h"
#include "sdk/tools/terminal.h"
#include "sdk/tools/timing.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;

FlightArguments on_all_cores() {
  FlightArguments flight;
  flight.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return flight;
}

struct FlyArguments {
  std::string mission_file, out, check;
  MissionOverrides overrides;
  std::optional<std::int64_t> seed;
  bool keys = false;
  FlightArguments flight = on_all_cores();
};

/// runs/POLICY-CAVE-SEED, with a number behind it if that is taken.
fs::path default_run_dir(const Mission& m) {
  const std::string name = m.policy + "-" + fs::path(m.cave).stem().string() + "-" + std::to_string(m.seed);
  fs::path dir = fs::path("runs") / name;
  for (int i = 2; fs::exists(dir); ++i) dir = fs::path("runs") / (name + "-" + std::to_string(i));
  return dir;
}

void print_summary(const nlohmann::json& metrics, const fs::path& run_dir, bool with_report) {
  const auto number = [&](const char* key, const char* format) {
    if (metrics[key].is_null()) return std::string("unknown");
    std::array<char, 64> text;
    std::snprintf(text.data(), text.size(), format, metrics[key].get<double>());
    return std::string(text.data());
  };
  print_out("%s: %s\n", metrics["outcome"].get<std::string>().c_str(),
            metrics["reason"].get<std::string>().c_str());
  print_out("  flight time      %s\n  path length      %s\n  mean speed       %s\n",
            number("flight_time_s", "%.0f s").c_str(), number("path_length_m", "%.0f m").c_str(),
            number("mean_speed_mps", "%.2f m/s").c_str());
  print_out("  explored volume  %s", number("explored_volume_m3", "%.0f m^3").c_str());
  if (!metrics["coverage"].is_null())
    print_out(" (%.1f %% of what can be reached)", 100 * metrics["coverage"].get<double>());
  print_out("\n  least clearance  %s\n", number("min_clearance_m", "%.2f m").c_str());
  print_objects(metrics);
  print_out("Look next at:\n");
  if (with_report)
    print_out("  %s   the flight in 3D with plots; open it in a browser\n",
              (run_dir / "report.html").c_str());
  print_out("  %s   all figures\n", (run_dir / "metrics.json").c_str());
}

/// The mission's vehicle at the cave's start, which records in `run_dir` unless that is "".
std::unique_ptr<core::Vehicle> make_vehicle(const Mission& mission, const std::string& run_dir) {
  core::VehicleSetup setup;
  setup.cave = mission.cave;
  setup.start = mission.start;
  setup.run_dir = run_dir;
  setup.climb_m = mission.core.mission.takeoff_height_m;
  setup.seed = static_cast<std::uint64_t>(mission.seed);
  std::unique_ptr<core::Vehicle> vehicle = mission.vehicle_plugin->create(setup);
  core::check(mission.core, vehicle->description());
  return vehicle;
}

boost::property_tree::ptree as_flown(const Mission& mission, const host::HostedPolicy& policy) {
  return recorded_mission(mission, policy.parameters(), policy.version());
}

/// Everything that a flight would look at before its take-off, and nothing of a flight.
int check(const std::string& file, const Mission& mission, const host::HostedPolicy& policy) {
  make_vehicle(mission, "");  // looks at the cave and the start
  write_mission(file, as_flown(mission, policy));
  return 0;
}

/// Said now: nothing is lost without it but time, and nobody would notice that.
void make_cave_cache(const fs::path& folder) {
  if (folder.empty()) return;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder) || access(folder.c_str(), W_OK) != 0)
    throw core::InputError("karst fly", "--cave-cache " + folder.string(),
                           "is no folder that can be written" + (error ? ": " + error.message() : ""));
}

int fly(const FlyArguments& args) {
  if (args.keys) {
    std::fputs(mission_help("simulator").c_str(), stdout);
    return 0;
  }
  if (args.mission_file.empty() && args.overrides.cave.empty())
    throw core::InputError("karst fly", "", "needs a MISSION file or --cave FILE; see karst fly --help");
  MissionOverrides overrides = args.overrides;
  if (args.seed) overrides.values.emplace_back("seed", std::to_string(*args.seed));
  Mission mission = read_mission(args.mission_file, overrides);
  settle_policy(mission);
  core::check(mission.core.team, mission.core.homing, mission.file);
  if (!mission.cave.empty()) check_cave(mission.cave, mission.start);
  make_cave_cache(args.flight.cave_cache);

  if (mission.core.team.robots > 1) {
    FlightArguments flight = args.flight;
    flight.run_dir = args.out.empty() ? default_run_dir(mission) : run_dir_of(args.out);
    flight.interrupted = &watch_for_interrupt();
    return fly_team(mission, flight, args.check);
  }

  // Everything that can be wrong is looked at before anything is written.
  const std::unique_ptr<host::HostedPolicy> policy = host::load_policy(policy_choice(mission, args.flight));
  if (!args.check.empty()) return check(args.check, mission, *policy);
  const fs::path run_dir = args.out.empty() ? default_run_dir(mission) : run_dir_of(args.out);
  const std::atomic<bool>& interrupted = watch_for_interrupt();  // from here on there is something to tidy up
  RunClaim claim(run_dir);
  core::Recorder recorder(run_dir);
  const std::unique_ptr<core::Vehicle> vehicle = make_vehicle(mission, run_dir.string());
  write_mission(run_dir / "mission.info", as_flown(mission, *policy));
  if (interrupted) throw core::InputError("karst fly", "", "stopped by the operator before take-off");
  claim.keep();
  if (!mission.policy_selection.empty())
    recorder.event(0, "selection", {{"policy", mission.policy}, {"reason", mission.policy_selection}});

  std::optional<host::RecordingPolicy> recording;
  if (args.flight.record_requests)
    recording.emplace(*policy, run_dir / host::kRequestLogName,
                      host::RequestLogHeader{policy->name(), policy->version(), policy_seed(mission),
                                             policy->parameters()});
  core::PolicyPort& asked = recording ? static_cast<core::PolicyPort&>(*recording) : *policy;

  core::Executive executive(args.flight.threads,
                            args.flight.real_time ? core::Clock::real_time : core::Clock::lockstep);
  core::MissionControl control(mission.core, *vehicle, executive, asked, recorder);
  int code = kNotLanded;
  try {
    StatusLine line(args.flight.quiet || args.flight.json);
    const auto begin = std::chrono::steady_clock::now();
    {
      const core::StallWatch stall({&executive}, args.flight.real_time ? kStallInRealTime : kStallInLockstep,
                                   [&](const std::string& running) { end_stalled(running, run_dir); });
      control.fly([&](const core::MissionStatus& status) {
        line.show(status);
        return !interrupted.load();
      });
    }
    const core::MissionResult result = control.end();
    line.end();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    write_timing(run_dir, executive, wall.count());
    const nlohmann::json metrics =
        finish_run(run_dir, mission.cave, mission.start, !args.flight.no_report, args.flight.cave_cache);
    if (args.flight.json) {
      print_json(metrics);
    } else {
      print_summary(metrics, run_dir, !args.flight.no_report);
    }
    if (!result.record_problem.empty()) throw std::runtime_error(result.record_problem);
    if (result.outcome == "landed") code = std::fflush(stdout) == 0 ? 0 : 1;
  } catch (const std::exception& e) {  // a full disk: it flew all the same
    print_error("karst: %s\nkarst: the flight's record is incomplete: %s\n", e.what(), run_dir.c_str());
  }
  if (policy->abandoned()) {  // its thread hangs in the plugin: nothing may be torn down
    std::fflush(stdout);
    std::_Exit(code);
  }
  return code;
}

}  // namespace

void add_fly_command(CLI::App& app) {
  auto args = std::make_shared<FlyArguments>();
  CLI::App* fly_app = app.add_subcommand(
      "fly",
      "Fly one mission and write its run directory and report.\n\n"
      "  karst fly examples/missions/demo.info\n"
      "  karst fly --cave caves/tunnel.stl --start \"1 2 1.5 90\" --policy highest_frontier\n"
      "  karst fly demo.info --set motion.max_speed=\"1 m/s\" --set simulator.gust=\"2 m/s\" --seed 4\n\n"
      "Exit code: 0 landed at the start (of a team: all landed), 2 flown but not landed there or the record "
      "is incomplete, 1 not "
      "flown or nothing could be printed.");
  fly_app->add_option("mission", args->mission_file, "mission file (.info)")->check(not_empty());
  fly_app->add_option("--cave", args->overrides.cave, "cave .info file or mesh (STL, PLY, OBJ, DAE)")
      ->check(not_empty());
  fly_app
      ->add_option("--start", args->overrides.start, "\"x y z [heading_deg]\" above the floor to start from")
      ->check(not_empty());
  fly_app
      ->add_option("--policy", args->overrides.policy,
                   "exploration policy; see karst policy list; auto: selected for the cave")
      ->check(not_empty());
  fly_app
      ->add_option("--preset", args->overrides.preset, "file with a policy and its parameters (docs/tune.md)")
      ->check(not_empty());
  fly_app->add_option("--plugin", args->flight.plugins, "policy plugin file (.so) to look in first")
      ->allow_extra_args(false)
      ->check(not_empty());
  fly_app->add_option("--set", args->overrides.settings, "key=value; see --keys")->allow_extra_args(false);
  fly_app->add_option("--seed", args->seed, "seed of every random stream")->check(not_empty());
  fly_app->add_option("--out", args->out, "run directory; default runs/POLICY-CAVE-SEED")->check(not_empty());
  fly_app
      ->add_option("--threads", args->flight.threads,
                   "1: all on one thread; 2 or more: sensing and mapping on a thread of their own. "
                   "Results do not depend on it")
      ->check(CLI::Range(1, 256));
  fly_app->add_flag(
      "--real-time", args->flight.real_time,
      "a second of flight takes a second, as on a vehicle: what is not ready in time counts as an "
      "overrun (timing.json), and no two flights are the same");
  fly_app->add_flag("--json", args->flight.json, "print metrics.json instead of a summary; no status line");
  fly_app->add_flag("--quiet", args->flight.quiet, "no status line");
  fly_app->add_flag("--no-report", args->flight.no_report, "metrics only, no report.html");
  fly_app
      ->add_option(
          "--cave-cache", args->flight.cave_cache,
          "folder that keeps what the evaluation works out of a cave, for other flights in it; made if "
          "it is not there")
      ->check(not_empty());
  fly_app
      ->add_option("--check", args->check,
                   "do not fly: look at everything that can be wrong and write the mission as resolved to "
                   "this file")
      ->check(not_empty());
  fly_app->add_flag(
      "--record-requests", args->flight.record_requests,
      "write what the policy is asked, and its answers, into requests.bin; see karst policy replay");
  fly_app->add_flag("--keys", args->keys, "list every key of a mission file and end");
  fly_app->callback([args] {
    if (const int code = fly(*args); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace karst::tools
