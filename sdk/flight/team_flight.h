// Joins several vehicles into one flight: the world they share, the base, the radio between all of them,
// the nodes they drop, the faults injected into them, and the team's log.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core_stack/mission/team/team_member.h"
#include "plugins/simulator/simulated_world.h"
#include "sdk/flight/lockstep.h"
#include "sdk/flight/team_faults.h"
#include "sdk/flight/team_log.h"
#include "sdk/flight/team_object_log.h"

namespace karst::flight {

/// The result of one robot.
struct RobotResult {
  core::MissionResult mission;
  double start_s = 0, end_s = 0;  // team's time
  double exploration_time_s = 0;  // before homing
  std::string homing_reason;      // why exploration ended
  double battery_left = 0;        // fraction
  bool connected = false;         // to the base over the relay graph at the end, as known to the base
  std::uint32_t records = 0, records_at_base = 0;  // published by it; held by the base
};

struct TeamResult {
  std::vector<RobotResult> robots;
  double duration_s = 0;
  std::uint64_t bytes_on_air = 0;
  std::string record_problem;  // why a run directory is incomplete; empty if all are complete
};

/// The inputs of a team's flight besides its vehicles and policies.
struct TeamFlightSetup {
  core::CoreOptions options;
  TeamFaults faults;
  std::uint64_t seed = 1;
  core::MissionKey key;
  std::filesystem::path run_dir;  // for team.jsonl, which never contains the radio key
};

class TeamFlight final : public StepHooks {
 public:
  /// Throws core::InputError if the log cannot be written. The world outlives the flight.
  TeamFlight(const TeamFlightSetup& setup, sim::SimulatedWorld& world);

  /// The options that its members fly by.
  const core::CoreOptions& options() const { return options_; }
  std::size_t size() const { return members_.size(); }
  core::Teamwork& teamwork(std::size_t robot) { return members_.at(robot)->teamwork(); }
  /// The time at which a robot is switched on.
  core::TimeNs starts_at(std::size_t robot) const;

  void on_start(std::size_t robot, core::TimeNs now) override;
  void exchange(Lockstep& flight, core::TimeNs now) override;
  void on_phase(const Lockstep& flight, std::size_t robot, core::TimeNs now) override;
  void inject_faults(const Lockstep& flight, core::TimeNs now) override;

  /// The result of a flight that is over at `now`. Closes the log and the world's files.
  TeamResult result(const Lockstep& flight, core::TimeNs now);

 private:
  void place_nodes(core::TimeNs now);
  void talk(Lockstep& flight, core::TimeNs now);
  void log_base(core::TimeNs now);
  RobotResult result_of(const Lockstep& flight, std::size_t robot, core::TimeNs now) const;
  std::uint64_t log_traffic(core::TimeNs now);

  core::CoreOptions options_;
  TeamFaults faults_;
  core::TeamSetup setup_;
  sim::SimulatedWorld& world_;
  core::TeamNode base_;
  std::vector<std::unique_ptr<core::TeamMember>> members_;
  std::vector<bool> struck_;                            // members into which a fault was injected
  std::vector<std::unique_ptr<core::TeamNode>> nodes_;  // in the order of their drops
  core::HomingTree base_tree_;                          // as reported to the base, for the log
  TeamLog log_;
  TeamObjectLog object_log_;
};

}  // namespace karst::flight
