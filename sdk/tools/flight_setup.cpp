#include "sdk/tools/flight_setup.h"

#include <algorithm>
#include <boost/property_tree/info_parser.hpp>
#include <cstdio>
#include <cstdlib>

#include "core_stack/common/error.h"
#include "sdk/host/file_access.h"

namespace karst::tools {

void end_stalled(const std::string& running, const std::filesystem::path& run_dir) {
  std::fprintf(stderr,
               "karst: %s does not return: the flight is given up\nkarst: its record ends early: %s\n",
               running.empty() ? "a step" : ("\"" + running + "\"").c_str(), run_dir.c_str());
  std::_Exit(kNotLanded);
}

host::PolicyChoice policy_choice(const Mission& mission, const FlightArguments& args) {
  host::PolicyChoice choice;
  choice.name = mission.policy;
  choice.plugin_files = args.plugins;
  choice.parameters = mission.policy_parameters;
  choice.source = mission.file;
  choice.seed = policy_seed(mission);
  const bool own_process = mission.policy_isolation == "process";
  choice.isolation = own_process ? host::Isolation::process : host::Isolation::in_process;
  if (own_process && host::landlock_version() == 0)
    std::fputs("warning: this kernel has no Landlock: the policy's process can read what this user can\n",
               stderr);
  choice.memory_limit_mib = mission.policy_memory_limit_mib;
  choice.cpu_limit_s = mission.policy_cpu_limit_s;
  // In lockstep the vehicle's clock stands still meanwhile: a loaded machine must not cost a policy its
  // flight. On a vehicle nobody waits longer than until the next decision is due, for a policy that can be
  // started once more.
  choice.hang_limit_s = mission.policy_hang_limit_s;
  if (args.real_time)
    choice.hang_limit_s = std::min(choice.hang_limit_s, own_process ? mission.core.mission.decision_period_s
                                                                    : mission.policy_cpu_limit_s);
  return choice;
}

void write_mission(const std::filesystem::path& file, const boost::property_tree::ptree& mission) {
  try {
    boost::property_tree::write_info(file.string(), mission);
  } catch (const boost::property_tree::info_parser_error& e) {
    throw core::InputError(file.string(), "", e.message());
  }
}

}  // namespace karst::tools
