#include "sdk/tools/fly_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/install_location.h"
#include "core_stack/common/shell_word.h"
#include "sdk/evaluation/metrics/summary.h"
#include "sdk/flight/auto_policy.h"
#include "sdk/flight/cave_check.h"
#include "sdk/flight/fly.h"
#include "sdk/flight/run_files.h"
#include "sdk/host/plugin/selection.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"
#include "sdk/tools/interrupt.h"
#include "sdk/tools/mesh_options.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;

struct FlyArguments {
  std::string mission_file, out, check, flight_time;
  flight::MissionOverrides overrides;
  std::optional<std::int64_t> seed;
  fs::path cave_cache;
  std::vector<std::string> plugins;
  MeshOptions mesh;
  int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  bool keys = false, force = false, json = false, quiet = false, no_report = false, real_time = false,
       record_requests = false, in_process = false;
  LiveArguments live;
};

/// runs/POLICY-CAVE-SEED, with a number appended if that exists.
fs::path default_run_dir(const flight::Mission& m) {
  const std::string where = m.cave.empty() ? m.vehicle : fs::path(m.cave).stem().string();
  const std::string name = m.policy + "-" + where + "-" + std::to_string(m.seed);
  fs::path dir = fs::path("runs") / name;
  for (int i = 2; fs::exists(dir); ++i) dir = fs::path("runs") / (name + "-" + std::to_string(i));
  return dir;
}

/// Prints a line of the summary if there were objects of interest.
void print_objects(const nlohmann::ordered_json& m) {
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

/// Of one vehicle, or of a whole team.
void print_outcome(const nlohmann::ordered_json& metrics, const evaluation::Ending& ending) {
  const std::string how = ending.sentence.empty() ? metrics["reason"].get<std::string>() : ending.sentence;
  print_wrapped(stdout, 2, "%s: %s;\n  %s\n", metrics["outcome"].get<std::string>().c_str(),
                evaluation::achievement_of(metrics, ending).c_str(), how.c_str());
}

/// How to look into a policy that broke: the run directory is that of its own vehicle.
void print_way_to_debug(const fs::path& run_dir, const FlyArguments& args) {
  if (!args.record_requests)
    return print_error("karst: to repeat this in a debugger, fly with --record-requests\n");
  std::string command = "gdb --args karst policy replay " + core::shell_word(run_dir.string());
  for (const std::string& plugin : args.plugins) command += " --plugin " + core::shell_word(plugin);
  print_error("karst: `%s` repeats this in a debugger\n", command.c_str());
}

/// On standard error, whatever else is printed: what flew is not what was to be flown.
void print_broken_policies(const std::vector<evaluation::Ending>& endings, const fs::path& run_dir,
                           const FlyArguments& args) {
  const bool team = endings.size() > 1;
  for (std::size_t i = 0; i < endings.size(); ++i) {
    const auto& failed = endings[i].failed_policy;
    const auto& restart = endings[i].restart;
    const std::string robot = "robot " + std::to_string(i + 1);
    if (restart)
      print_error("karst: %s%s\n", team ? (robot + ": ").c_str() : "", sentence_of(*restart).c_str());
    if (failed)
      print_error("karst: the policy %sfailed at %.1f s, and the fallback took over: %s\n",
                  team ? ("of " + robot + " ").c_str() : "", failed->time_s, failed->why.c_str());
    const evaluation::LostDecisions& lost = endings[i].lost_decisions;
    if (lost.count > 0 && !failed)
      print_error("karst: the policy %sfailed in %s, the last time: %s\n",
                  team ? ("of " + robot + " ").c_str() : "", core::counted(lost.count, "decision").c_str(),
                  lost.last.c_str());
    if (restart || failed || lost.count > 0)
      print_way_to_debug(team ? run_dir / ("robot_" + std::to_string(i + 1)) : run_dir, args);
  }
}

/// On standard error as well: a crash that the vehicle survived, and the traceback of an exception, are the
/// author's to look into.
void print_last_output(const std::vector<flight::PolicyPrinted>& printed,
                       const std::vector<evaluation::Ending>& endings) {
  for (const flight::PolicyPrinted& p : printed) {
    const bool lost = p.vehicle < endings.size() && endings[p.vehicle].lost_decisions.count > 0;
    flight::show_last_lines(p.policy, p.before_break.empty() && lost ? p.last_lines : p.before_break);
    if (!p.problem.empty()) print_error("karst: %s\n", p.problem.c_str());
  }
}

void print_output_files(const std::vector<flight::PolicyPrinted>& printed) {
  for (const flight::PolicyPrinted& p : printed)
    print_out("  %s   what the policy printed\n", p.file.c_str());
}

/// How punctual the control step was, and what was left out.
void print_real_time(const flight::RealTimeOutcome& real_time) {
  const core::DurationHistogram& late = real_time.control.lateness;
  const auto ms = [&](core::TimeNs t) { return 1e3 * core::seconds(t); };
  print_out(
      "  control steps    late by p50 %.2f, p99 %.2f, p99.9 %.2f, at most %.2f ms; %llu of %llu missed their "
      "deadline\n",
      ms(late.quantile(0.5)), ms(late.quantile(0.99)), ms(late.quantile(0.999)), ms(late.max()),
      static_cast<unsigned long long>(real_time.control.missed_deadlines),
      static_cast<unsigned long long>(late.count()));
  if (real_time.degraded.empty()) return;
  std::string what;
  for (const auto& [relief, times] : real_time.degraded)
    what += (what.empty() ? "" : ", ") + std::string(core::name_of(relief)) + " (" +
            core::counted(times, "time") + ")";
  print_wrapped(stdout, 19, "  degraded         %s\n", what.c_str());
}

void print_flight(const flight::FlightOutcome& outcome, const flight::FlightRequest& request) {
  const nlohmann::ordered_json& metrics = outcome.metrics;
  const auto number = [&](const char* key, const char* format) {
    if (metrics[key].is_null()) return std::string("unknown");
    std::array<char, 64> text;
    std::snprintf(text.data(), text.size(), format, metrics[key].get<double>());
    return std::string(text.data());
  };
  print_outcome(metrics, evaluation::joint_ending(outcome.endings));
  print_out("  flight time      %s\n  path length      %s\n  mean speed       %s\n",
            number("flight_time_s", "%.0f s").c_str(), number("path_length_m", "%.0f m").c_str(),
            number("mean_speed_mps", "%.2f m/s").c_str());
  print_out("  explored volume  %s", number("explored_volume_m3", "%.0f m³").c_str());
  if (!metrics["coverage"].is_null())
    print_out(" (%.1f %% of what can be reached%s)", 100 * metrics["coverage"].get<double>(),
              metrics.contains("coverage_of") ? " in the region" : "");
  print_out("\n  least clearance  %s\n", number("min_clearance_m", "%.2f m").c_str());
  print_objects(metrics);
  if (outcome.real_time) print_real_time(*outcome.real_time);
  print_out("Look next at:\n");
  if (request.report == flight::Report::written)
    print_out("  %s   the flight in 3D with plots; open it in a browser\n",
              (request.run_dir / "report.html").c_str());
  print_out("  %s   all figures\n", (request.run_dir / "metrics.json").c_str());
  print_output_files(outcome.printed);
}

void print_team(const flight::FlightOutcome& outcome, const flight::FlightRequest& request) {
  const flight::TeamResult& team = *outcome.team;
  const bool known = outcome.endings.size() == team.robots.size();
  print_outcome(outcome.metrics, evaluation::joint_ending(outcome.endings));
  print_out("  robot  explored  outcome    at the base\n");
  for (std::size_t i = 0; i < team.robots.size(); ++i) {
    const flight::RobotResult& r = team.robots[i];
    print_wrapped(stdout, 9, "  %5zu  %6.0f s  %-9s  %s, %u of %u records   %s\n", i + 1,
                  r.exploration_time_s, core::name_of(r.mission.outcome),
                  r.connected ? "connected" : "cut off", r.records_at_base, r.records,
                  (known ? outcome.endings[i].sentence : r.mission.reason).c_str());
  }
  print_objects(outcome.metrics);
  print_out("  over the air     %.0f kB in %.0f s\nLook next at:\n",
            1e-3 * static_cast<double>(team.bytes_on_air), team.duration_s);
  if (request.report == flight::Report::written)
    print_out("  %s   all robots over time, in a browser\n", (request.run_dir / "report.html").c_str());
  print_out(
      "  %s   what became of the team, and what the base knew when\n  %s   the first robot's own flight\n",
      (request.run_dir / "team.jsonl").c_str(), (request.run_dir / "robot_1").c_str());
  print_output_files(outcome.printed);
}

/// Reports errors early: without the cache only time would be lost, which nobody would notice.
void make_cave_cache(const fs::path& folder) {
  if (folder.empty()) return;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder) || access(folder.c_str(), W_OK) != 0)
    throw core::InputError("karst fly", "--cave-cache " + folder.string(),
                           "is not a writable directory" + (error ? ": " + error.message() : ""));
}

/// Says what `policy auto` chose: before take-off, since it may be a reason not to fly.
void print_choice(const flight::Mission& mission) {
  std::string parameters;
  for (const auto& [key, value] : mission.policy_parameters)
    parameters += (parameters.empty() ? " with " : ", ") + key + "=" + value.data();
  print_wrapped(stdout, 2, "policy auto: %s%s\n  %s\n", mission.policy.c_str(), parameters.c_str(),
                mission.policy_selection.c_str());
  std::fflush(stdout);  // the status line is another stream
}

/// What options of their own set, as key and value. Throws InputError if --set sets one of them, too.
std::vector<std::pair<std::string, std::string>> values_of_options(const FlyArguments& args) {
  std::vector<std::pair<std::string, std::string>> values;
  const auto set = [&](const std::string& option, const std::string& key, const std::string& value) {
    for (const std::string& setting : args.overrides.settings)
      if (setting.starts_with(key + "="))
        throw core::InputError("karst fly", option, "sets " + key + ", and so does --set: give one of them");
    values.emplace_back(key, value);
  };
  if (args.seed) set("--seed", "seed", std::to_string(*args.seed));
  if (!args.flight_time.empty()) set("--time", "mission.max_flight_time", args.flight_time);
  if (args.in_process) set("--in-process", "policy.isolation", "in_process");
  for (const auto& [key, value] : args.mesh) set("--" + key, "cave." + key, value);
  return values;
}

flight::Mission mission_of(const FlyArguments& args, const PolicyChooser& choose_policy) {
  flight::MissionOverrides overrides = args.overrides;
  for (auto& value : values_of_options(args)) overrides.values.push_back(std::move(value));
  flight::Mission mission = flight::read_mission(args.mission_file, overrides);
  const bool is_auto = mission.policy == flight::kAutoPolicy;
  choose_policy(mission);
  if (is_auto && !args.quiet && !args.json) print_choice(mission);
  flight::check(mission.faults, mission.core.team.robots, mission.file);
  core::check(mission.core.team, mission.core.homing, mission.file);
  if (!mission.cave.empty())
    for (const std::string& note :
         flight::check_cave(mission.cave, mission.start, mission.mesh, args.cave_cache))
      if (!args.quiet) print_error("note: %s: %s\n", mission.cave.c_str(), note.c_str());
  return mission;
}

flight::FlightRequest request_of(const FlyArguments& args, const flight::Mission& mission) {
  flight::FlightRequest request;
  request.run_dir = args.out.empty() ? default_run_dir(mission) : flight::run_dir_of(args.out);
  request.cave_cache = args.cave_cache;
  request.plugins = args.plugins;
  request.threads = args.threads;
  request.clock = args.real_time ? core::Clock::real_time : core::Clock::lockstep;
  request.report = args.no_report ? flight::Report::none : flight::Report::written;
  request.old_run = args.force ? flight::OldRun::replaced : flight::OldRun::kept;
  request.record_requests = args.record_requests;
  request.notes = !args.quiet;
  request.status_line = !args.quiet && !args.json;
  return request;
}

void check_live(const FlyArguments& args) {
  if (args.live.asked && args.mission_file.find(':') != std::string::npos && !fs::exists(args.mission_file))
    throw core::InputError("karst fly", "--live " + args.mission_file,
                           "an address stands after an equals sign: --live=" + args.mission_file);
  const char* of_environment = std::getenv("KARST_LIVE_TOKEN");
  if (!args.live.asked && !args.live.token.empty() && (!of_environment || args.live.token != of_environment))
    throw core::InputError("karst fly", "--live-token", "the flight is not served: add --live");
}

int fly(const FlyArguments& args, const PolicyChooser& choose_policy, const LiveStarter& start_live) {
  if (args.keys) {
    std::fputs(flight::mission_help(flight::named_vehicle(args.mission_file, args.overrides)).c_str(),
               stdout);
    return 0;
  }
  const auto names_vehicle = [](const std::string& setting) { return setting.starts_with("vehicle="); };
  if (args.mission_file.empty() && args.overrides.cave.empty() &&
      std::none_of(args.overrides.settings.begin(), args.overrides.settings.end(), names_vehicle))
    throw core::InputError("karst fly", "", "needs a MISSION file or --cave FILE; see karst fly --help");
  const flight::Mission mission = mission_of(args, choose_policy);
  make_cave_cache(args.cave_cache);
  flight::FlightRequest request = request_of(args, mission);
  std::shared_ptr<core::RecordListener> live;  // outlives the flight
  if (args.live.asked && args.check.empty()) live = start_live(mission, request, args.live);
  request.listener = live.get();

  // All inputs are checked before anything is written.
  flight::MissionFlight mission_flight(mission, request);
  if (!args.check.empty()) {
    mission_flight.check(args.check);
    return 0;
  }
  // From here on an interrupt needs an orderly shutdown.
  const flight::FlightOutcome outcome = mission_flight.fly(watch_for_interrupt());
  if (outcome.metrics.is_object()) {
    if (args.json)
      print_json(outcome.metrics);
    else if (outcome.team)
      print_team(outcome, request);
    else
      print_flight(outcome, request);
  }
  print_broken_policies(outcome.endings, request.run_dir, args);
  print_last_output(outcome.printed, outcome.endings);
  if (!outcome.record_problem.empty())
    print_wrapped(stderr, 7, "karst: %s\nkarst: the %s record is incomplete: %s\n",
                  outcome.record_problem.c_str(), flight::is_team(mission) ? "flights'" : "flight's",
                  request.run_dir.c_str());
  int code = flight::kNotAsMeant;
  if (outcome.as_meant) code = std::fflush(stdout) == 0 ? 0 : 1;
  if (mission_flight.hangs()) {  // nothing may be destroyed
    std::fflush(stdout);
    std::_Exit(code);
  }
  return code;
}

/// What is flown: the mission, or what stands for one.
void add_mission_options(CLI::App& fly_app, FlyArguments& args) {
  fly_app.add_option("mission", args.mission_file, "mission file (.info)")
      ->type_name(kFile)
      ->check(not_empty());
  fly_app.add_option("--cave", args.overrides.cave, "cave .info file or mesh (STL, PLY, OBJ, DAE)")
      ->type_name(kFile)
      ->check(not_empty());
  fly_app
      .add_option("--start", args.overrides.start, "\"x y z [heading_deg]\" above the floor to start from")
      ->check(not_empty());
  add_mesh_options(fly_app, args.mesh);
  fly_app
      .add_option(
          "--policy", args.overrides.policy,
          "exploration policy, or a file with one (my_policy.py); see karst policy list; auto: selected "
          "for the cave")
      ->type_name(kPolicy)
      ->check(not_empty());
  fly_app
      .add_option("--preset", args.overrides.preset,
                  "file with a policy and its parameters (" + core::doc_path("docs/tune.md") + ")")
      ->type_name(kFile)
      ->check(not_empty());
  fly_app.add_option("--plugin", args.plugins, "file with policies (.so or .py) to look in first")
      ->type_name(kFile)
      ->allow_extra_args(false)
      ->check(not_empty());
  fly_app.add_option("--set", args.overrides.settings, "key=value; see --keys")
      ->type_name(kSetting)
      ->allow_extra_args(false);
  fly_app.add_option("--seed", args.seed, "seed of every random stream")->check(not_empty());
  fly_app
      .add_option("--time", args.flight_time,
                  "flight time, such as \"300 s\" or 5min: short for --set mission.max_flight_time")
      ->check(not_empty());
}

/// Returns --live.
const CLI::Option* add_live_options(CLI::App& fly_app, LiveArguments& args) {
  const CLI::Option* live = fly_app.add_flag(
      "--live{127.0.0.1:8765}", args.address,
      "=ADDRESS:PORT: serve the flight as it goes, for Foxglove and for a page at this address; "
      "127.0.0.1:8765 if no address is given: " +
          core::doc_path("docs/live.md"));
  fly_app
      .add_option("--live-token", args.token,
                  "what clients of --live must give; needed beyond this machine's own address")
      ->envname("KARST_LIVE_TOKEN")
      ->check(not_empty());
  return live;
}

}  // namespace

void add_fly_command(CLI::App& app, PolicyChooser choose_policy, LiveStarter start_live) {
  auto args = std::make_shared<FlyArguments>();
  CLI::App* fly_app = app.add_subcommand(
      "fly",
      "Fly one mission and write its run directory and report\n\n"
      "  karst fly mission.info\n"
      "  karst fly --cave caves/tunnel.stl --start \"1 2 1.5 90\" --policy highest_frontier\n"
      "  karst fly mission.info --set motion.max_speed=\"1 m/s\" --set simulator.gust=\"2 m/s\" --seed 4\n\n"
      "Missions to start from: " +
          core::doc_path("examples/missions") +
          "\n\n"
          "Exit code: 0 the mission went as planned: explored until nothing was left, or the time or the "
          "battery, and landed at the start or as a relay (of a team: all did). 2 it did not: sent home or "
          "down early, landed elsewhere, or the record is incomplete. 1 not flown, or nothing could be "
          "printed.");
  add_mission_options(*fly_app, *args);
  fly_app->add_option("--out", args->out, "run directory; default runs/POLICY-CAVE-SEED")
      ->type_name(kFolder)
      ->check(not_empty());
  fly_app->add_flag("--force", args->force, "replace the flight that is in the run directory already");
  fly_app
      ->add_option("--threads", args->threads,
                   "1: all on one thread; 2 or more: sensing and mapping on a thread of their own. "
                   "Results do not depend on it")
      ->check(CLI::Range(1, 256));
  fly_app->add_flag(
      "--real-time", args->real_time,
      "a second of flight takes a second, as on a vehicle, with real-time priorities and locked memory where "
      "they are allowed; no two flights are the same: " +
          core::doc_path("docs/real_time.md"));
  const CLI::Option* live_flag = add_live_options(*fly_app, args->live);
  fly_app->add_flag("--json", args->json, "print metrics.json instead of a summary; no status line");
  fly_app->add_flag("--quiet", args->quiet, "no status line, no notes, nothing on what policy auto chose");
  fly_app->add_flag("--no-report", args->no_report, "metrics only, no report.html");
  fly_app
      ->add_option(
          "--cave-cache", args->cave_cache,
          "folder that keeps what the evaluation works out of a cave, for other flights in it; made if "
          "it is not there")
      ->type_name(kFolder)
      ->check(not_empty());
  fly_app
      ->add_option("--check", args->check,
                   "do not fly: look at everything that can be wrong and write the mission as resolved to "
                   "this file")
      ->type_name(kFile)
      ->check(not_empty());
  fly_app->add_flag(
      "--record-requests", args->record_requests,
      "write what the policy is asked, and its answers, into requests.bin; see karst policy replay");
  fly_app->add_flag("--in-process", args->in_process,
                    "run the policy in karst's own process, for debuggers and sanitizers; a crash then ends "
                    "the flight: " +
                        core::doc_path("docs/isolation.md"));
  fly_app->add_flag("--keys", args->keys,
                    "list every key of a mission file and end: of the simulator, or of the vehicle that the "
                    "mission or --set "
                    "names");
  fly_app->callback([args, live_flag, choose = std::move(choose_policy), live = std::move(start_live)] {
    args->live.asked = live_flag->count() > 0;
    check_live(*args);
    host::take_policy_file(args->overrides.policy, args->plugins);
    if (const int code = fly(*args, choose, live); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace karst::tools
