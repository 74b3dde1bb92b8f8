// From a mission to what flies it: the missions of a team's members, their policies, their vehicles.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core_stack/team/communication/mission_key.h"
#include "plugins/simulator/simulated_world.h"
#include "sdk/flight/finish_run.h"
#include "sdk/flight/mission_file.h"
#include "sdk/host/load_policy.h"

namespace karst::flight {

/// How to fly, rather than what.
struct FlightRequest {
  std::filesystem::path run_dir, cave_cache;
  std::vector<std::string> plugins;  // policies' files to look in first
  int threads = 1;
  core::Clock clock = core::Clock::lockstep;
  Report report = Report::written;
  bool record_requests = false;
  bool notes = true, status_line = true;  // on standard error
};

inline bool is_team(const Mission& mission) { return mission.core.team.robots > 1; }

/// The mission of each vehicle: of one alone the mission itself; of a member of a team that of a vehicle that
/// flies from its own place, with its own random streams.
std::vector<Mission> missions_of_members(const Mission& mission);

/// The run directory of a member: of one vehicle alone the flight's, of a team's a folder in it.
std::filesystem::path member_run_dir(const std::filesystem::path& run_dir, const Mission& mission,
                                     std::size_t member);

/// Which policy, and what it may do to this process.
host::PolicyChoice policy_choice(const Mission& mission, const FlightRequest& request);

/// The key that a team's frames on the radio are authenticated with.
core::MissionKey radio_key(const Mission& mission);

/// What carries the core stacks: one vehicle, or several in one world.
struct Vehicles {
  std::unique_ptr<core::Vehicle> alone;
  std::unique_ptr<sim::SimulatedWorld> world;  // null: one vehicle alone
  core::Vehicle& operator[](std::size_t i) const { return world ? world->robot(i) : *alone; }
};

/// At the cave's start, recording into `run_dir` unless that is "". Throws core::InputError on a bad cave or
/// start, and for a vehicle that the mission cannot be flown with.
Vehicles make_vehicles(const Mission& mission, const std::vector<Mission>& members,
                       const std::filesystem::path& run_dir);

/// Throws core::InputError if it cannot be written.
void write_mission(const std::filesystem::path& file, const boost::property_tree::ptree& mission);

}  // namespace karst::flight
