#include "sdk/tools/fly_team.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/random.h"
#include "core_stack/common/stall_watch.h"
#include "core_stack/mission/team_mission.h"
#include "core_stack/vehicle/team_vehicles.h"
#include "sdk/evaluation/metrics.h"
#include "sdk/tools/report_command.h"
#include "sdk/tools/run_files.h"
#include "sdk/tools/status_line.h"
#include "sdk/tools/team_metrics.h"
#include "sdk/tools/terminal.h"
#include "sdk/tools/timing.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;

/// One robot of the team, as if it flew alone: from its own place, with its own random streams.
Mission mission_of(const Mission& team, std::size_t robot) {
  Mission m = team;
  const auto stream =
      core::Random::stream(static_cast<std::uint64_t>(team.seed), "robot " + std::to_string(robot + 1))
          .bits();
  m.seed = static_cast<std::int64_t>(stream >> 12);  // within what a mission file may say
  m.resolved.put("seed", m.seed);
  for (const char* section : {"team", "homing", "radio"}) m.resolved.erase(section);
  return m;
}

std::string folder_of(std::size_t robot) { return "robot_" + std::to_string(robot + 1); }

std::unique_ptr<core::TeamVehicles> make_vehicles(const Mission& mission, const std::vector<Mission>& robots,
                                                  const fs::path& run_dir) {
  auto* plugin = dynamic_cast<core::TeamVehiclePlugin*>(mission.vehicle_plugin);
  if (!plugin)
    throw core::InputError(mission.file, "team.robots", "the vehicle " + mission.vehicle + " knows no teams");
  core::TeamSetup setup;
  setup.world.cave = mission.cave;
  setup.world.start = mission.start;
  setup.world.run_dir = run_dir.string();
  setup.world.climb_m = mission.core.mission.takeoff_height_m;
  setup.world.seed = static_cast<std::uint64_t>(mission.seed);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    setup.run_dirs.push_back(run_dir.empty() ? "" : (run_dir / folder_of(i)).string());
    setup.seeds.push_back(static_cast<std::uint64_t>(robots[i].seed));
    setup.starts_after_s.push_back(std::round(mission.core.team.stagger_s) * static_cast<double>(i));
  }
  auto vehicles = plugin->create_team(setup);
  for (std::size_t i = 0; i < robots.size(); ++i) core::check(mission.core, vehicles->robot(i).description());
  return vehicles;
}

core::MissionKey radio_key(const Mission& mission) {
  const std::string& file = mission.core.team.key_file;
  return file.empty() ? core::key_of_seed(static_cast<std::uint64_t>(mission.seed)) : core::read_key(file);
}

/// Whoever sets one of the two easily forgets the other, and lands out of reach, or nearer than need be.
void compare_radio_with_belief(const Mission& mission) {
  const std::string believed = mission.resolved.get("homing.landing.link.range", "");
  const std::string real = mission.resolved.get("radio.range", believed);
  if (believed != real)
    print_error(
        "karst: note: the radio reaches %s (radio.range), and the robots land as if it were %s "
        "(homing.landing.link.range)\n",
        real.c_str(), believed.c_str());
}

/// A line every half minute of the mission.
class TeamStatus {
 public:
  explicit TeamStatus(bool quiet) : quiet_(quiet) {}
  void show(core::TimeNs now, const std::vector<core::MissionStatus>& robots) const {
    if (quiet_ || now % (30 * core::kSecond) != 0) return;
    std::string line = std::to_string(now / core::kSecond) + " s:";
    for (std::size_t i = 0; i < robots.size(); ++i)
      line += "  " + std::to_string(i + 1) + " " + name_of(robots[i].phase);
    print_error("%s\n", line.c_str());
  }

 private:
  bool quiet_;
};

void print_summary(const core::TeamResult& result, const nlohmann::json& metrics, const fs::path& run_dir,
                   bool with_report) {
  print_out("%s: %s\n", metrics["outcome"].get<std::string>().c_str(),
            metrics["reason"].get<std::string>().c_str());
  print_out("  robot  explored  outcome    at the base\n");
  for (std::size_t i = 0; i < result.robots.size(); ++i) {
    const core::RobotResult& r = result.robots[i];
    print_out("  %5zu  %6.0f s  %-9s  %s, %u of %u records   %s\n", i + 1, r.exploration_time_s,
              r.mission.outcome.c_str(), r.connected ? "connected" : "cut off", r.records_at_base, r.records,
              r.mission.reason.c_str());
  }
  print_objects(metrics);
  print_out("  over the air     %.0f kB in %.0f s\nLook next at:\n",
            1e-3 * static_cast<double>(result.bytes_on_air), result.duration_s);
  if (with_report)
    print_out("  %s   all robots over time, in a browser\n", (run_dir / "report.html").c_str());
  print_out(
      "  %s   what became of the team, and what the base knew when\n  %s   the first robot's own flight\n",
      (run_dir / "team.jsonl").c_str(), (run_dir / folder_of(0)).c_str());
}

}  // namespace

int fly_team(const Mission& mission, const FlightArguments& args, const std::string& check) {
  if (args.real_time)
    throw core::InputError("karst fly", "--real-time",
                           "a team flies in lockstep only: its vehicles share a world");
  if (args.record_requests)
    throw core::InputError("karst fly", "--record-requests", "of a team no requests are recorded");
  std::vector<Mission> robots;
  std::vector<std::unique_ptr<host::HostedPolicy>> policies;
  for (std::size_t i = 0; i < static_cast<std::size_t>(mission.core.team.robots); ++i) {
    robots.push_back(mission_of(mission, i));
    policies.push_back(host::load_policy(policy_choice(robots.back(), args)));
  }
  const auto record = [&](const Mission& m) {
    return recorded_mission(m, policies.front()->parameters(), policies.front()->version());
  };
  const core::MissionKey key = radio_key(mission);
  if (!check.empty()) {
    make_vehicles(mission, robots, "");  // looks at the cave and the starts
    write_mission(check, record(mission));
    return 0;
  }

  if (!args.quiet) compare_radio_with_belief(mission);
  const fs::path& run_dir = args.run_dir;
  RunClaim claim(run_dir);
  std::vector<std::unique_ptr<RunClaim>> own_claims;
  std::vector<std::unique_ptr<core::Recorder>> recorders;
  std::vector<core::TeamSeat> seats;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    own_claims.push_back(std::make_unique<RunClaim>(run_dir / folder_of(i)));
    recorders.push_back(std::make_unique<core::Recorder>(run_dir / folder_of(i)));
    seats.push_back({policies[i].get(), recorders.back().get()});
  }
  const auto vehicles = make_vehicles(mission, robots, run_dir);
  write_mission(run_dir / "mission.info", record(mission));
  for (std::size_t i = 0; i < robots.size(); ++i) {
    robots[i].start = vehicles->start_of(i);
    write_mission(run_dir / folder_of(i) / "mission.info", record(robots[i]));
  }
  claim.keep();
  for (const auto& own : own_claims) own->keep();

  core::TeamMission team(mission.core, *vehicles, seats, static_cast<std::uint64_t>(mission.seed), key,
                         run_dir, args.threads);
  const TeamStatus status(args.quiet || args.json);
  const auto begin = std::chrono::steady_clock::now();
  const core::TeamResult result = [&] {
    std::vector<const core::Executive*> executives;
    for (std::size_t i = 0; i < robots.size(); ++i) executives.push_back(&team.executive(i));
    const core::StallWatch stall(executives, kStallInLockstep,
                                 [&](const std::string& running) { end_stalled(running, run_dir); });
    return team.run([&](core::TimeNs now, const auto& all) {
      status.show(now, all);
      return !args.interrupted->load();
    });
  }();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;

  int code = kNotLanded;
  try {
    // First what the flight itself knows: should the evaluation be killed, as for want of memory, it is not
    // lost.
    std::vector<nlohmann::json> own(robots.size());
    evaluation::write_metrics(run_dir, team_metrics(mission, result, own));
    for (std::size_t i = 0; i < robots.size(); ++i) {
      write_timing(run_dir / folder_of(i), team.executive(i), wall.count());
      own[i] =
          finish_run(run_dir / folder_of(i), mission.cave, mission.start, !args.no_report, args.cave_cache);
    }
    nlohmann::ordered_json metrics = team_metrics(mission, result, own);
    evaluation::write_metrics(run_dir, metrics);
    write_team_timing(run_dir, result.duration_s, wall.count(), args.threads);
    finish_team(run_dir, mission.cave, mission.start, metrics, !args.no_report, args.cave_cache);
    if (args.json)
      print_json(metrics);
    else
      print_summary(result, metrics, run_dir, !args.no_report);
    if (!result.record_problem.empty()) throw std::runtime_error(result.record_problem);
    if (metrics["outcome"] == "landed") code = std::fflush(stdout) == 0 ? 0 : 1;
  } catch (const std::exception& e) {  // a full disk: they flew all the same
    print_error("karst: %s\nkarst: the flights' record is incomplete: %s\n", e.what(), run_dir.c_str());
  }
  const bool hangs =
      std::any_of(policies.begin(), policies.end(), [](const auto& p) { return p->abandoned(); });
  if (hangs) {  // its thread hangs in the plugin: nothing may be torn down
    std::fflush(stdout);
    std::_Exit(code);
  }
  return code;
}

}  // namespace karst::tools
