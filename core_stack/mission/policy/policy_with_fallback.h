// The policy with a fallback that replaces it: permanently once the policy has failed, and for one decision
// cycle when it has left the vehicle idle for too long.
//
// It runs on the map lane.
#pragma once
#include <optional>
#include <string>

#include "core_stack/mission/policy/fallback_policy.h"
#include "core_stack/mission/policy/output_budget.h"
#include "core_stack/mission/policy/policy_port.h"

namespace karst::core {

enum class DecidedBy { policy, fallback };

struct PolicyAnswer {
  Decision decision;  // drawings and log are within the flight's limits
  DecidedBy by = DecidedBy::policy;
  std::string name;     // of the policy that decided
  std::string failure;  // of the policy, if it failed in this call
};

class PolicyWithFallback {
 public:
  /// `policy` must outlive it.
  explicit PolicyWithFallback(PolicyPort& policy) : policy_(&policy) {}

  /// Chooses who is asked throughout the decision cycle that begins now.
  DecidedBy begin_cycle(TimeNs now);
  PolicyAnswer ask(const DecisionRequest& request, DecidedBy by);
  PolicyAnswer ask_fallback(const DecisionRequest& request);
  /// A policy that has failed is no longer notified.
  void notify(const PolicyEvent& event);

  // How the cycle ended: busy if the vehicle flies or has a goal, else idle.

  void note_busy() { idle_since_.reset(); }
  void note_idle(TimeNs now) {
    if (!idle_since_) idle_since_ = now;
  }

 private:
  PolicyPort* policy_;
  FallbackPolicy fallback_;
  bool failed_ = false;
  std::optional<TimeNs> idle_since_;
  OutputBudget output_budget_;
};

}  // namespace karst::core
