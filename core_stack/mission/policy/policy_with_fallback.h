// The policy, and the fallback that decides in its place: for good once the policy has failed, and for one
// decision cycle when it has let the vehicle stand idle for too long.
//
// It lives on the map lane.
#pragma once
#include <optional>
#include <string>

#include "core_stack/mission/policy/fallback_policy.h"
#include "core_stack/mission/policy/output_budget.h"
#include "core_stack/mission/policy/policy_port.h"

namespace karst::core {

enum class DecidedBy { policy, fallback };

struct PolicyAnswer {
  Decision decision;  // within the flight's limits of drawings and log
  DecidedBy by = DecidedBy::policy;
  std::string name;     // of who decided
  std::string failure;  // of the policy, if it failed in this call
};

class PolicyWithFallback {
 public:
  /// `policy` outlives it.
  explicit PolicyWithFallback(PolicyPort& policy) : policy_(&policy) {}

  /// Who is to be asked all through the decision cycle that begins now.
  DecidedBy begin_cycle(TimeNs now);
  PolicyAnswer ask(const DecisionRequest& request, DecidedBy by);
  PolicyAnswer ask_fallback(const DecisionRequest& request);
  /// A policy that has failed is not told any more.
  void notify(const PolicyEvent& event);

  // How the cycle ended: with the vehicle under way or a goal for it, or without either.

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
