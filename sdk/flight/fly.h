// Flies a mission of one vehicle or of a team, from loading the policies to the finished run directory
// (docs/run_directory.md). A team's run directory has one sub-folder robot_N for each robot, which is a run
// directory, and the team's own files.
#pragma once
#include <atomic>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sdk/evaluation/metrics/ending.h"
#include "sdk/flight/flight_setup.h"
#include "sdk/flight/loaded_policies.h"
#include "sdk/flight/service_manager.h"
#include "sdk/flight/successive_policies.h"
#include "sdk/flight/team_flight.h"

namespace karst::flight {

constexpr int kNotAsMeant = 2;  // exit code of a flight whose mission did not go as planned

/// Of a flight in real time.
struct RealTimeOutcome {
  core::Punctuality control;                           // of the control step
  std::vector<std::pair<core::Relief, int>> degraded;  // and how often
};

struct FlightOutcome {
  bool as_meant = false;  // the mission went so, of every vehicle, and the record is complete
  std::vector<evaluation::Ending> endings;  // of each vehicle; empty if they are not known
  nlohmann::ordered_json metrics;           // null if they could not be computed
  std::optional<TeamResult> team;           // for a team's flight
  std::vector<PolicyPrinted> printed;       // of each vehicle whose policy's process printed something
  std::optional<RealTimeOutcome> real_time;
  std::string record_problem;  // why the record is incomplete; "" if it is not
};

class MissionFlight {
 public:
  /// Loads the policies. Throws core::InputError if the mission cannot be flown, before anything is written.
  MissionFlight(const Mission& mission, const FlightRequest& request);
  ~MissionFlight();

  /// Makes all checks that precede a take-off, and writes the resolved mission.
  void check(const std::filesystem::path& mission_file) const;
  /// Flies and records into the request's run directory; once `interrupted` is set, all vehicles land. Throws
  /// core::InputError if no vehicle took off: then the run directory is as it was.
  FlightOutcome fly(const std::atomic<bool>& interrupted);
  /// True if a policy's thread hangs in its plugin: then this object must not be destroyed.
  bool hangs() const;

 private:
  struct Running;
  boost::property_tree::ptree as_asked(const Mission& mission) const;
  boost::property_tree::ptree as_flown(const Mission& mission) const;
  void prepare(const std::atomic<bool>& interrupted);
  void assemble();
  std::vector<Seat> seats() const;
  RealTime real_time();
  Successor successor(const core::DecisionRequest& request);
  core::TimeNs run(const std::atomic<bool>& interrupted);
  nlohmann::ordered_json finish_alone(FlightOutcome& outcome, double wall_s) const;
  nlohmann::ordered_json finish_members(FlightOutcome& outcome, double wall_s) const;
  std::vector<PolicyPrinted> printed() const;

  Mission mission_;
  FlightRequest request_;
  std::vector<Mission> members_;
  LoadedPolicies loaded_;
  std::unique_ptr<host::HostedPolicy> later_;  // of policy.later, until it takes over
  std::optional<core::MissionKey> key_;        // of a team
  std::atomic<bool> in_the_air_ = false;
  std::unique_ptr<Running> running_;  // kept after the flight: see hangs()
};

}  // namespace karst::flight
