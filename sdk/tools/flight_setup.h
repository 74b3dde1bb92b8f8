// What flights of one vehicle and of a team share: from a mission to its policy and its record.
#pragma once
#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "sdk/host/hosted_policy.h"
#include "sdk/tools/mission_file.h"

namespace karst::tools {

/// What the command line says of how to fly, rather than what.
struct FlightArguments {
  std::filesystem::path run_dir, cave_cache;
  std::vector<std::string> plugins;  // policies' files to look in first
  int threads = 1;
  bool json = false, quiet = false, no_report = false, real_time = false, record_requests = false;
  const std::atomic<bool>* interrupted = nullptr;
};

constexpr int kNotLanded = 2;  // exit code of a flight that did not end with the vehicle where it should land

// How long a step or job may take before the flight is given up: longer than any decision or plan takes, on
// any machine.
constexpr std::chrono::seconds kStallInLockstep{600}, kStallInRealTime{30};

/// Ends the process, as the step or job `running` does not return: what hangs holds what would have to be
/// torn down. The record is complete up to the last second.
[[noreturn]] void end_stalled(const std::string& running, const std::filesystem::path& run_dir);

/// Which policy, and what it may do to this process.
host::PolicyChoice policy_choice(const Mission& mission, const FlightArguments& args);

/// Throws core::InputError if it cannot be written.
void write_mission(const std::filesystem::path& file, const boost::property_tree::ptree& mission);

}  // namespace karst::tools
