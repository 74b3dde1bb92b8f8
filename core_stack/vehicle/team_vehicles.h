// What carries a team: its vehicles in one world, and the radio between them. Only what the radio carries
// passes from one vehicle to another.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

/// Bytes over the air of one radio.
struct RadioTraffic {
  std::uint64_t bytes_sent = 0, bytes_dropped = 0, bytes_heard = 0, bytes_lost = 0, bytes_weak = 0;
  std::uint64_t packets_sent = 0, packets_heard = 0, packets_corrupted = 0;
};

class TeamVehicles {
 public:
  virtual ~TeamVehicles() = default;

  virtual Vehicle& robot(std::size_t i) = 0;
  /// Where a robot starts, as VehicleSetup::start has it.
  virtual std::string start_of(std::size_t i) const = 0;
  /// The base's antenna, known to everybody before the mission. World frame.
  virtual Vec3 base() const = 0;

  /// All vehicles have come to `now`, the team's time: from here on each sees where the others are, and
  /// radios are where their vehicles are. What touched since the last call crashes.
  virtual void meet(TimeNs now) = 0;
  /// A radio fails: it neither sends nor hears any more.
  virtual void silence(std::size_t radio) = 0;
  /// A robot is lost where it is, its radio with it.
  virtual void wreck(std::size_t robot, const std::string& reason) = 0;

  /// A robot drops a communication node: from now on there is a radio of that number where it comes to lie.
  virtual void drop_node(std::size_t robot, std::size_t radio) = 0;

  /// Radios are numbered: 0 is the base, i + 1 robot i, dropped nodes as drop_node() was told.
  virtual void send(std::size_t radio, std::span<const std::uint8_t> bytes, TimeNs now) = 0;
  virtual std::vector<std::vector<std::uint8_t>> receive(std::size_t radio, TimeNs until) = 0;
  virtual RadioTraffic traffic(std::size_t radio) const = 0;
  /// Closes files.
  virtual void finish() = 0;
};

/// What a vehicle plugin is given to set up a team.
struct TeamSetup {
  VehicleSetup world;                  // cave, start, the team's run directory and seed; the climb of all
  std::vector<std::string> run_dirs;   // of the robots; "" for none
  std::vector<std::uint64_t> seeds;    // of the robots
  std::vector<double> starts_after_s;  // when each robot's own clock begins, in the team's time
};

/// A vehicle plugin that knows teams, too.
class TeamVehiclePlugin : public VehiclePlugin {
 public:
  /// The section `radio` of the mission file.
  virtual void describe_radio(OptionTable& table) = 0;
  /// Throws InputError on bad input.
  virtual std::unique_ptr<TeamVehicles> create_team(const TeamSetup& setup) = 0;
};

}  // namespace karst::core
