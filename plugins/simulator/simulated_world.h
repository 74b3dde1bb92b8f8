// A simulated world with several vehicles and their radios, as seen by the code that runs a flight. Each core
// stack has access to its own vehicle and port only.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core_stack/vehicle/team_port.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::sim {

/// Radio traffic of one radio. heard: received; weak: below the receiver's sensitivity.
struct RadioTraffic {
  std::uint64_t bytes_sent = 0, bytes_dropped = 0, bytes_heard = 0, bytes_lost = 0, bytes_weak = 0;
  std::uint64_t packets_sent = 0, packets_heard = 0, packets_corrupted = 0;
};

/// Radios are numbered: 0 is the base, i + 1 robot i, a dropped node the number given to
/// TeamPort::drop_node(). Ports stay valid as long as the world.
class SimulatedWorld {
 public:
  virtual ~SimulatedWorld() = default;

  virtual core::Vehicle& robot(std::size_t i) = 0;
  virtual core::TeamPort& port(std::size_t robot) = 0;
  /// The radio of the base or of a dropped node.
  virtual core::RadioPort& radio(std::size_t number) = 0;
  /// A robot's start pose, in the format of VehicleSetup::start.
  virtual std::string start_of(std::size_t i) const = 0;
  /// Position of the base's antenna, known to all robots before the mission. World frame, m.
  virtual core::Vec3 base() const = 0;

  /// To be called when all vehicles have reached `now`, the team's time: updates the positions of the other
  /// vehicles for each one's sensors, and of the radios. Vehicles that touched since the last call crash.
  virtual void meet(core::TimeNs now) = 0;
  virtual RadioTraffic traffic(std::size_t radio) const = 0;
  /// Closes files.
  virtual void finish() = 0;

  // Faults.
  /// A radio fails: it neither transmits nor receives any more.
  virtual void silence(std::size_t radio) = 0;
  /// A robot is lost at its present position, and its radio fails.
  virtual void wreck(std::size_t robot, const std::string& reason) = 0;
};

struct WorldSetup {
  core::VehicleSetup world;            // cave, start, take-off climb, the team's run directory and seed
  std::vector<std::string> run_dirs;   // of each robot; "" for none
  std::vector<std::uint64_t> seeds;    // of each robot
  std::vector<double> starts_after_s;  // when each robot's own clock begins, in the team's time
};

/// A vehicle plugin that can also create worlds with several vehicles.
class SimulatedWorldPlugin : public core::VehiclePlugin {
 public:
  /// Adds the options of the mission file's section `radio`.
  virtual void describe_radio(core::OptionTable& table) = 0;
  /// Throws InputError on bad input.
  virtual std::unique_ptr<SimulatedWorld> create_world(const WorldSetup& setup) = 0;
};

}  // namespace karst::sim
