// The policies of a flight: in processes of their own or in this one (docs/isolation.md), and what they
// print.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sdk/flight/flight_setup.h"
#include "sdk/host/boundary/policy_output.h"

namespace karst::flight {

struct LoadedPolicies {
  host::Isolation isolation = host::Isolation::in_process;
  std::vector<std::shared_ptr<host::PolicyOutput>> outputs;   // of each vehicle; empty in process
  std::vector<std::unique_ptr<host::HostedPolicy>> policies;  // of each vehicle
};

/// Loads the policy of each vehicle. Where this machine cannot confine a process and `policy.isolation` does
/// not insist on one, they are loaded in process, with a note. Throws core::InputError; what the policy's
/// process printed before is then shown.
LoadedPolicies load_policies(const std::vector<Mission>& members, const FlightRequest& request);

/// What a vehicle's policy printed in its own process.
struct PolicyPrinted {
  std::size_t vehicle = 0;
  std::string policy;
  std::filesystem::path file;
  std::string before_break;  // the last lines before the process broke; "" if it did not
  std::string last_lines;    // of the whole flight
  std::string problem;       // why the file is incomplete; "" if it is not
};

/// Shows lines that a policy printed on standard error, each behind a mark: none can pass for one of karst's.
void show_last_lines(const std::string& policy, const std::string& lines);

}  // namespace karst::flight
