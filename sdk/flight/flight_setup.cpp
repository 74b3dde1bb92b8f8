#include "sdk/flight/flight_setup.h"

#include <algorithm>
#include <boost/property_tree/info_parser.hpp>
#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/common/random.h"

namespace karst::flight {
namespace {

namespace fs = std::filesystem;

Mission mission_of_member(const Mission& team, std::size_t member) {
  Mission m = team;
  const auto stream =
      core::Random::stream(static_cast<std::uint64_t>(team.seed), "robot " + std::to_string(member + 1))
          .bits();
  m.seed = static_cast<std::int64_t>(stream >> 12);  // in the range that a mission file allows
  m.resolved.put("seed", m.seed);
  for (const char* section : {"team", "homing", "radio"}) m.resolved.erase(section);
  return m;
}

std::unique_ptr<sim::SimulatedWorld> make_world(const Mission& mission, const std::vector<Mission>& members,
                                                const fs::path& run_dir) {
  auto* plugin = dynamic_cast<sim::SimulatedWorldPlugin*>(mission.vehicle_plugin);
  if (!plugin)
    throw core::InputError(mission.file, "team.robots", "the vehicle " + mission.vehicle + " knows no teams");
  sim::WorldSetup setup;
  setup.world = vehicle_setup(mission, run_dir);
  for (std::size_t i = 0; i < members.size(); ++i) {
    setup.run_dirs.push_back(run_dir.empty() ? "" : member_run_dir(run_dir, mission, i).string());
    setup.seeds.push_back(static_cast<std::uint64_t>(members[i].seed));
    setup.starts_after_s.push_back(std::round(mission.core.team.stagger_s) * static_cast<double>(i));
  }
  return plugin->create_world(setup);
}

}  // namespace

core::VehicleSetup vehicle_setup(const Mission& mission, const fs::path& run_dir, core::Clock clock) {
  core::VehicleSetup setup;
  setup.cave = mission.cave;
  setup.start = mission.start;
  setup.mesh = mission.mesh;
  setup.run_dir = run_dir.string();
  setup.climb_m = mission.core.mission.takeoff_height_m;
  setup.seed = static_cast<std::uint64_t>(mission.seed);
  setup.clock = clock;
  return setup;
}

std::vector<Mission> missions_of_members(const Mission& mission) {
  if (!is_team(mission)) return {mission};
  std::vector<Mission> members;
  for (std::size_t i = 0; i < static_cast<std::size_t>(mission.core.team.robots); ++i)
    members.push_back(mission_of_member(mission, i));
  return members;
}

fs::path member_run_dir(const fs::path& run_dir, const Mission& mission, std::size_t member) {
  return is_team(mission) ? run_dir / ("robot_" + std::to_string(member + 1)) : run_dir;
}

core::MissionKey radio_key(const Mission& mission) {
  const std::string& file = mission.core.team.key_file;
  return file.empty() ? core::key_of_seed(static_cast<std::uint64_t>(mission.seed)) : core::read_key(file);
}

Vehicles make_vehicles(const Mission& mission, const std::vector<Mission>& members, const fs::path& run_dir,
                       core::Clock clock) {
  Vehicles vehicles;
  if (is_team(mission))
    vehicles.world = make_world(mission, members, run_dir);
  else
    vehicles.alone = mission.vehicle_plugin->create(vehicle_setup(mission, run_dir, clock));
  for (std::size_t i = 0; i < members.size(); ++i) {
    core::check(mission.core, vehicles[i].description());
    core::check_region(mission.file, mission.core, vehicles[i].description());
  }
  return vehicles;
}

host::PolicyChoice policy_choice(const Mission& mission, const FlightRequest& request,
                                 host::Isolation isolation) {
  host::PolicyChoice choice;
  choice.name = mission.policy;
  choice.plugin_files = request.plugins;
  choice.parameters = mission.policy_parameters;
  choice.source = mission.file;
  choice.seed = policy_seed(mission);
  choice.isolation = isolation;
  const bool own_process = isolation == host::Isolation::process;
  choice.memory_limit_mib = mission.policy_memory_limit_mib;
  choice.cpu_limit_s = mission.policy_cpu_limit_s;
  // In lockstep the vehicle's clock stands still during a decision: a loaded machine must not end a policy.
  // On a real vehicle a policy in its own process, which can be restarted, is waited for only until the next
  // decision is due.
  choice.start_hang_limit_s = choice.hang_limit_s = mission.policy_hang_limit_s;
  if (request.clock == core::Clock::real_time)
    choice.hang_limit_s = std::min(choice.hang_limit_s, own_process ? mission.core.mission.decision_period_s
                                                                    : mission.policy_cpu_limit_s);
  return choice;
}

void write_mission(const fs::path& file, const boost::property_tree::ptree& mission) {
  try {
    boost::property_tree::write_info(file.string(), mission);
  } catch (const boost::property_tree::info_parser_error& e) {
    throw core::InputError(file.string(), "", e.message());
  }
}

}  // namespace karst::flight
