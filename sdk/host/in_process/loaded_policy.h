// A policy plugin opened in this process, behind the core's port.
#pragma once
#include <optional>
#include <string>

#include "sdk/host/boundary/decision_box.h"
#include "sdk/host/in_process/decision_thread.h"
#include "sdk/host/plugin/hosted_policy.h"
#include "sdk/host/plugin/parameters.h"
#include "sdk/host/plugin/plugin_file.h"
#include "sdk/host/serialization/flat_answer.h"
#include "sdk/host/services/session.h"

namespace karst::host {

class LoadedPolicy final : public HostedPolicy {
 public:
  /// Creates, initializes and activates. Restores a former object's state, if given; on failure logs the
  /// reason and starts without one. `lengths` and `paths` answer the path service in place of a request's
  /// roadmap.
  /// Throws core::InputError.
  LoadedPolicy(const PluginFile& plugin, const karst_policy_t& table, const PolicyChoice& choice,
               const PolicyLegacy& former = {}, PathLengths lengths = {}, PathSearch paths = {});
  ~LoadedPolicy() override { end(); }

  std::string name() const override { return name_; }
  const std::string& version() const override { return version_; }
  const std::string& file() const override { return file_; }
  const boost::property_tree::ptree& parameters() const override { return parameters_.tree(); }
  bool abandoned() const override { return thread_.hangs(); }

  core::Decision decide(const core::DecisionRequest& request) override;
  void notify(const core::PolicyEvent& event) override;

  /// The data with which another object can continue. A state that the policy fails to save is left out.
  PolicyLegacy legacy();

 private:
  struct Call;
  /// Runs `work(call)`, which returns a result code, on the decision thread. Returns "" or the failure.
  template <class Work>
  std::string call(const char* slot, Work work);
  /// What is said on stderr if the policy crashes in this slot.
  std::string if_it_crashes(const std::string& slot) const;
  /// Throws core::InputError if there is a fault.
  void require(const std::string& fault) const;
  void start(const PolicyLegacy& former);
  void create_and_init();
  /// "" if there is no state, or it was restored.
  std::string restore(const PolicyLegacy& former);
  void end() noexcept;
  core::Decision failed(const std::string& why);
  void warn_of_change(const std::string& what, const std::string& when);
  void refuse(const core::DecisionRequest& request, const DecisionBox& box);

  const karst_policy_t& table_;
  std::string name_, version_, file_;
  PolicyChoice choice_;
  ResolvedParameters parameters_;
  PathLengths lengths_;
  PathSearch paths_;
  std::shared_ptr<Session> session_;
  DecisionThread thread_;
  void* self_ = nullptr;
  bool active_ = false;
  int failures_ = 0;                // consecutive failures of decide
  std::uint32_t last_request_ = 0;  // its number; 0: none yet
};

}  // namespace karst::host
