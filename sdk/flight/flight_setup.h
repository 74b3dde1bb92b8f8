// From a mission to its vehicles: the missions of a team's members, their policies, their vehicles.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core_stack/mission/recording/record_listener.h"
#include "core_stack/team/communication/mission_key.h"
#include "plugins/simulator/simulated_world.h"
#include "sdk/flight/finish_run.h"
#include "sdk/flight/mission_file.h"
#include "sdk/flight/run_files.h"
#include "sdk/host/load_policy.h"

namespace karst::flight {

/// Options of a flight that are not part of the mission.
struct FlightRequest {
  std::filesystem::path run_dir, cave_cache;
  std::vector<std::string> plugins;  // plugin files that are searched first
  int threads = 1;
  core::Clock clock = core::Clock::lockstep;
  Report report = Report::written;
  OldRun old_run = OldRun::kept;
  bool record_requests = false;
  bool notes = true, status_line = true;     // on standard error
  core::RecordListener* listener = nullptr;  // to the record of a single vehicle; outlives the flight
};

inline bool is_team(const Mission& mission) { return mission.core.team.robots > 1; }

/// The mission of each vehicle. For a single vehicle, the mission itself; for a member of a team, the mission
/// with its own random streams.
std::vector<Mission> missions_of_members(const Mission& mission);

/// The run directory of a member: the flight's for a single vehicle, a folder in it for a team's member.
std::filesystem::path member_run_dir(const std::filesystem::path& run_dir, const Mission& mission,
                                     std::size_t member);

/// The policy to load, with its limits.
host::PolicyChoice policy_choice(const Mission& mission, const FlightRequest& request,
                                 host::Isolation isolation);

/// The key that authenticates a team's radio frames.
core::MissionKey radio_key(const Mission& mission);

/// The vehicles that the core stacks fly: one alone, or several in one world.
struct Vehicles {
  std::unique_ptr<core::Vehicle> alone;
  std::unique_ptr<sim::SimulatedWorld> world;  // null: one vehicle alone
  core::Vehicle& operator[](std::size_t i) const { return world ? world->robot(i) : *alone; }
};

/// Creates the vehicles at the cave's start, recording into `run_dir` unless that is "". Throws
/// core::InputError on a bad cave or start, and for a vehicle that cannot fly the mission.
Vehicles make_vehicles(const Mission& mission, const std::vector<Mission>& members,
                       const std::filesystem::path& run_dir, core::Clock clock = core::Clock::lockstep);

/// What the mission's vehicle is set up with.
core::VehicleSetup vehicle_setup(const Mission& mission, const std::filesystem::path& run_dir,
                                 core::Clock clock = core::Clock::lockstep);

/// Throws core::InputError if it cannot be written.
void write_mission(const std::filesystem::path& file, const boost::property_tree::ptree& mission);

}  // namespace karst::flight
