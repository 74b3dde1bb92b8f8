// A policy plugin behind the core's port: in this process, or in a separate one (docs/isolation.md).
//
// In this process the plugin runs on its own decision thread. A call that exceeds a time limit is
// abandoned: its services fail from then on, should_stop() returns nonzero, and PolicyFailure is thrown.
// Nothing else depends on a wall clock, and this is a failure path: a replay of a run in which
// no policy hangs is bit-identical.
//
// A thread cannot be killed. If it never returns, it stays until the process ends; `abandoned()` is then
// true, and a tool should end with std::quick_exit or _exit once its files are written, because the stuck
// code may still run while static objects are destroyed.
#pragma once
#include <boost/property_tree/ptree.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/mission/policy/policy_port.h"

namespace karst::host {

class PolicyOutput;

enum class Isolation { in_process, process };
constexpr auto names_of(Isolation) {
  using enum Isolation;
  return std::to_array<core::Named<Isolation>>({{in_process, "in_process"}, {process, "process"}});
}

/// Thrown in place of starting a policy with Isolation::process, where the policy has no part in it: this
/// machine lacks what confines a process.
struct CannotConfine : core::InputError {
  explicit CannotConfine(const std::string& reason)
      : InputError("policy.isolation", "process", "this machine cannot confine a policy: " + reason) {}
};

/// The policy settings of a mission file or a command line.
struct PolicyChoice {
  std::string name;
  std::vector<std::string> plugin_files;   // --plugin, before everything else
  boost::property_tree::ptree parameters;  // values as text with units, such as "2 m"
  std::string source = "policy";           // the file the parameters come from, for messages
  std::uint64_t seed = 1;
  double hang_limit_s = 60.0;        // for a call, by the wall clock
  double start_hang_limit_s = 60.0;  // the same for the first start of a policy's own process
  Isolation isolation = Isolation::in_process;
  double cpu_limit_s = 10.0;  // for a call: of its thread, or of all threads of the policy's own process
  std::int64_t memory_limit_mib = 2048;  // of a policy's own process
  std::shared_ptr<PolicyOutput> output;  // takes what that prints; null: dropped
  int failures_allowed = 2;              // consecutive; one more is a PolicyFailure
};

class HostedPolicy : public core::PolicyPort {
 public:
  ~HostedPolicy() override = default;
  virtual const std::string& version() const = 0;
  virtual const std::string& file() const = 0;
  /// Every parameter with the value in force, as read from a mission file.
  virtual const boost::property_tree::ptree& parameters() const = 0;
  /// True once the plugin hangs on its thread.
  virtual bool abandoned() const = 0;
};

}  // namespace karst::host
