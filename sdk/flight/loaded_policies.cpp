#include "sdk/flight/loaded_policies.h"

#include <cstdio>
#include <sstream>

#include "core_stack/common/error.h"
#include "sdk/host/isolation/file_access.h"
#include "sdk/terminal/terminal.h"

namespace karst::flight {
namespace {

LoadedPolicies loaded_so(const std::vector<Mission>& members, const FlightRequest& request,
                         host::Isolation isolation) {
  LoadedPolicies loaded;
  loaded.isolation = isolation;
  for (const Mission& member : members) {
    host::PolicyChoice choice = policy_choice(member, request, isolation);
    if (isolation == host::Isolation::process)
      choice.output = loaded.outputs.emplace_back(std::make_shared<host::PolicyOutput>());
    try {
      loaded.policies.push_back(host::load_policy(choice));
    } catch (const core::InputError&) {
      if (choice.output) show_last_lines(choice.name, choice.output->last_lines());
      throw;
    }
  }
  return loaded;
}

}  // namespace

LoadedPolicies load_policies(const std::vector<Mission>& members, const FlightRequest& request) {
  const PolicyIsolation asked = members.front().policy_isolation;
  if (asked == PolicyIsolation::in_process) return loaded_so(members, request, host::Isolation::in_process);
  const bool insists = asked == PolicyIsolation::process;
  if (insists && host::landlock_version() == 0)
    print_error("warning: this kernel has no Landlock: the policy's process can read what this user can\n");
  try {
    return loaded_so(members, request, host::Isolation::process);
  } catch (const host::CannotConfine& e) {
    if (insists) throw core::InputError(e, "; karst fly --in-process does without");
    if (request.notes)
      print_wrapped(stderr, 2,
                    "note: %s; %s flies in karst's own process, where a crash would end the flight\n",
                    e.what(), members.front().policy.c_str());
  }
  return loaded_so(members, request, host::Isolation::in_process);
}

void show_last_lines(const std::string& policy, const std::string& lines) {
  if (lines.empty()) return;
  std::string marked;
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) marked += "  | " + line + "\n";
  print_error("karst: what the policy %s printed last:\n%s", policy.c_str(), marked.c_str());
}

}  // namespace karst::flight
