// A simulated world with several vehicles in it and a radio between them, as whoever runs a flight sees it.
// What flies sees its own vehicle and its own port only.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core_stack/vehicle/team_port.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::sim {

/// Bytes over the air of one radio.
struct RadioTraffic {
  std::uint64_t bytes_sent = 0, bytes_dropped = 0, bytes_heard = 0, bytes_lost = 0, bytes_weak = 0;
  std::uint64_t packets_sent = 0, packets_heard = 0, packets_corrupted = 0;
};

/// Radios are numbered: 0 is the base, i + 1 robot i, dropped nodes as TeamPort::drop_node() was told. Ports
/// stay valid as long as the world.
class SimulatedWorld {
 public:
  virtual ~SimulatedWorld() = default;

  virtual core::Vehicle& robot(std::size_t i) = 0;
  virtual core::TeamPort& port(std::size_t robot) = 0;
  /// Of the base, or of a node that was dropped.
  virtual core::RadioPort& radio(std::size_t number) = 0;
  /// Where a robot starts, as VehicleSetup::start has it.
  virtual std::string start_of(std::size_t i) const = 0;
  /// The base's antenna, known to everybody before the mission. World frame.
  virtual core::Vec3 base() const = 0;

  /// All vehicles have come to `now`, the team's time: from here on each sees where the others are, and
  /// radios are where their vehicles are. What touched since the last call crashes.
  virtual void meet(core::TimeNs now) = 0;
  virtual RadioTraffic traffic(std::size_t radio) const = 0;
  /// Closes files.
  virtual void finish() = 0;

  // Faults.
  /// A radio fails: it neither sends nor hears any more.
  virtual void silence(std::size_t radio) = 0;
  /// A robot is lost where it is, its radio with it.
  virtual void wreck(std::size_t robot, const std::string& reason) = 0;
};

struct WorldSetup {
  core::VehicleSetup world;            // cave, start, the team's run directory and seed; the climb of all
  std::vector<std::string> run_dirs;   // of the robots; "" for none
  std::vector<std::uint64_t> seeds;    // of the robots
  std::vector<double> starts_after_s;  // when each robot's own clock begins, in the team's time
};

/// A vehicle plugin that has worlds with several vehicles, too.
class SimulatedWorldPlugin : public core::VehiclePlugin {
 public:
  /// The section `radio` of the mission file.
  virtual void describe_radio(core::OptionTable& table) = 0;
  /// Throws InputError on bad input.
  virtual std::unique_ptr<SimulatedWorld> create_world(const WorldSetup& setup) = 0;
};

}  // namespace karst::sim
