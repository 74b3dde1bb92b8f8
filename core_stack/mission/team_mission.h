// A team's mission: several vehicles in one world, each with its own core stack, in lockstep. They share
// nothing but what the radio carries.
//
// Every tenth of a second all vehicles have come to the same time; then each sees where the others are, and
// the radio carries what they said. In between each runs by itself, so that it does not matter which thread
// runs it when: the same mission gives the same bytes with any number of threads.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "core_stack/mission/mission_control.h"
#include "core_stack/mission/object_log.h"
#include "core_stack/mission/team_log.h"
#include "core_stack/vehicle/team_vehicles.h"

namespace karst::core {

struct TeamSeat {
  PolicyPort* policy = nullptr;
  Recorder* recorder = nullptr;
};

/// What became of one robot.
struct RobotResult {
  MissionResult mission;
  double start_s = 0, end_s = 0;  // team's time
  double exploration_time_s = 0;  // before homing
  std::string homing_reason;      // why that ended
  double battery_left = 0;        // share
  bool connected = false;         // to the base over the relay graph at the end, as the base knows
  std::uint32_t records = 0, records_at_base = 0;  // that it told; that the base holds
};

struct TeamResult {
  std::vector<RobotResult> robots;
  double duration_s = 0;
  std::uint64_t bytes_on_air = 0;
  std::string record_problem;  // why a run directory is not complete; empty if all are
};

/// Called every second of the team's time with every robot's status; returns false to have them all land.
using TeamWatch = std::function<bool(TimeNs now, const std::vector<MissionStatus>&)>;

class TeamMission {
 public:
  /// One seat a robot, robot 1 first. Writes team.jsonl into `run_dir`, but never the radio's key.
  TeamMission(const CoreOptions& options, TeamVehicles& vehicles, const std::vector<TeamSeat>& seats,
              std::uint64_t seed, const MissionKey& key, const std::filesystem::path& run_dir, int threads);
  ~TeamMission();

  TeamResult run(const TeamWatch& watch);
  /// Where a robot's steps and jobs ran, for timing.json.
  const Executive& executive(std::size_t robot) const;

 private:
  struct Robot;
  void advance(TimeNs now, bool starting);
  void start(Robot& robot);
  void land(Robot& robot, const char* reason);
  void fly_all_to(TimeNs time);
  void fly(Robot& robot, TimeNs time);
  void place_nodes(TimeNs now);
  void log_base(TimeNs now);
  void note_phases(TimeNs now);
  void strike(TimeNs now);
  void talk(TimeNs now);
  bool ask(const TeamWatch& watch, TimeNs now);
  bool over(TimeNs now) const;
  TeamResult result(TimeNs now);

  CoreOptions options_;
  TeamVehicles& vehicles_;
  std::vector<TeamSeat> seats_;
  std::uint64_t seed_;
  MissionKey key_;
  int threads_;
  Teammate base_;
  std::vector<std::unique_ptr<Robot>> robots_;
  std::vector<std::unique_ptr<Teammate>> nodes_;  // dropped, in that order
  HomingTree base_tree_;                          // as the base was told, for the log
  TeamLog log_;
  ObjectLog object_log_;
};

}  // namespace karst::core
