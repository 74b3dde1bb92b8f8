// A policy in a separate process, behind the core's port (docs/isolation.md).
//
// Whatever happens to that process, decide() returns or throws PolicyFailure. The first time the process
// breaks, decide() answers HOLD and a new one is started, which continues with the state that the policy
// saved last, if it offers that; the second time is a PolicyFailure.
#pragma once
#include <memory>

#include "sdk/host/isolation/policy_process.h"
#include "sdk/host/plugin/hosted_policy.h"
#include "sdk/host/serialization/flat_answer.h"

namespace karst::host {

class IsolatedPolicy final : public HostedPolicy {
 public:
  /// Starts the policy of `file`. Throws core::InputError, like a policy in this process, and CannotConfine.
  IsolatedPolicy(const std::string& file, const PolicyChoice& choice);
  ~IsolatedPolicy() override;

  std::string name() const override { return choice_.name; }
  const std::string& version() const override { return ready_.version; }
  const std::string& file() const override { return file_; }
  const boost::property_tree::ptree& parameters() const override { return ready_.parameters; }
  bool abandoned() const override { return false; }

  core::Decision decide(const core::DecisionRequest& request) override;
  void notify(const core::PolicyEvent& event) override;

  /// Process id of the policy's process; -1 if there is none.
  pid_t process_id() const { return process_ ? process_->id() : -1; }

 private:
  void start();
  /// Starts the process and waits until it has confined itself: nothing of the plugin runs in it yet.
  void start_confined(CallLimits limits);
  core::Decision ask(const core::DecisionRequest& request);
  RingMessage question(const char* call, Said kind, const Bytes& body, const core::DecisionRequest* request);
  /// Waits for the answer, and answers what the process asks meanwhile.
  RingMessage answer(const core::DecisionRequest* request);
  /// Restarts the process the first time. Throws PolicyFailure the second time.
  void recover(const std::string& why);
  core::Decision hold(const std::string& why);

  std::string file_;
  PolicyChoice choice_;
  ReadyReport ready_;
  PolicyLegacy legacy_;
  std::unique_ptr<PolicyProcess> process_;
  const core::VoxelMap* map_sent_ = nullptr;
  std::uint64_t revision_sent_ = 0;
  bool restarted_ = false;
  std::string broke_between_;  // why it broke in an event, until the next decision reports it
};

}  // namespace karst::host
