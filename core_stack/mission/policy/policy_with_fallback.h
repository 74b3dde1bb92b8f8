// The policy with a fallback that replaces it: permanently once the policy has failed, and for one decision
// cycle when it has left the vehicle idle for too long. An answer `explored` is not idleness: it is for
// mission control to believe it or not, and no reason to fly elsewhere.
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
  /// Whether the fallback has found nothing since the vehicle was busy last. It is then asked in each cycle
  /// in which the policy has no acceptable goal: both have to find nothing.
  bool fallback_stands_by() const { return fallback_found_nothing_ && !failed_; }
  /// A policy that has failed is no longer notified.
  void notify(const PolicyEvent& event);

  // How the cycle ended: busy if the vehicle flies or has a goal, else explored or idle.

  void note_busy() {
    idle_since_.reset();
    explored_ = fallback_found_nothing_ = false;
  }
  void note_explored(DecidedBy by) {
    explored_ = true;
    fallback_found_nothing_ |= by == DecidedBy::fallback;
  }
  void note_idle(TimeNs now) {
    explored_ = false;
    if (!idle_since_) idle_since_ = now;
  }

 private:
  PolicyPort* policy_;
  FallbackPolicy fallback_;
  bool failed_ = false;
  std::optional<TimeNs> idle_since_;
  bool explored_ = false;  // the last answer to a vehicle without a goal
  bool fallback_found_nothing_ = false;
  OutputBudget output_budget_;
};

}  // namespace karst::core
