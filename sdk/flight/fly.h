// Flies a mission, of one vehicle or of a team, from its policies to the finished run directory
// (docs/run_directory.md). A team's holds one sub-folder robot_N a robot, each a run directory of its own,
// and what is the team's beside them.
#pragma once
#include <atomic>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sdk/flight/flight_setup.h"
#include "sdk/flight/team_flight.h"

namespace karst::flight {

constexpr int kNotLanded = 2;  // exit code of a flight that did not end with the vehicle where it should land

struct FlightOutcome {
  bool landed = false;             // all vehicles where they should
  nlohmann::ordered_json metrics;  // null if they could not be worked out
  std::optional<TeamResult> team;  // if it was one
  std::string record_problem;      // why the record is incomplete; "" if it is not
};

class MissionFlight {
 public:
  /// Loads the policies. Throws core::InputError for what cannot be flown, before anything is written.
  MissionFlight(const Mission& mission, const FlightRequest& request);
  ~MissionFlight();

  /// Looks at everything that a flight looks at before its take-off, and writes the mission as resolved.
  void check(const std::filesystem::path& mission_file) const;
  /// Flies into the request's run directory; once `interrupted` is set, all land. Throws core::InputError if
  /// nothing took off: then the run directory is as it was.
  FlightOutcome fly(const std::atomic<bool>& interrupted);
  /// A policy's thread hangs in its plugin: this object must not be destroyed any more.
  bool hangs() const;

 private:
  struct Running;
  boost::property_tree::ptree as_flown(const Mission& mission) const;
  void prepare(const std::atomic<bool>& interrupted);
  void assemble();
  std::vector<Seat> seats() const;
  core::TimeNs run(const std::atomic<bool>& interrupted) const;
  nlohmann::ordered_json finish_alone(FlightOutcome& outcome, double wall_s) const;
  nlohmann::ordered_json finish_members(FlightOutcome& outcome, double wall_s) const;

  Mission mission_;
  FlightRequest request_;
  std::vector<Mission> members_;
  std::vector<std::unique_ptr<host::HostedPolicy>> policies_;
  std::optional<core::MissionKey> key_;  // of a team
  std::unique_ptr<Running> running_;     // kept after the flight: see hangs()
};

}  // namespace karst::flight
