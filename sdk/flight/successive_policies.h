// Two policies, one after the other: at a stated time of the flight another one may take over, once. Which
// one is known before the flight (`policy.later`), or decided then, by what the cave turned out to be
// (`policy.auto.reconsider`, auto_policy.h).
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core_stack/mission/policy/policy_port.h"
#include "sdk/host/load_policy.h"

namespace karst::flight {

/// The policy that takes over, and why; null: the first goes on.
struct Successor {
  std::unique_ptr<host::HostedPolicy> policy;
  std::string reason;
};

class SuccessivePolicies final : public core::PolicyPort {
 public:
  /// `review` is called in the first decision at `after` or later, by the vehicle's clock, and never again;
  /// it must not throw. `first` must outlive this.
  using Review = std::function<Successor(const core::DecisionRequest&)>;
  SuccessivePolicies(core::PolicyPort& first, core::TimeNs after, Review review)
      : first_(first), after_(after), review_(std::move(review)) {}

  std::string name() const override { return current().name(); }
  /// The decision in which the policy is reviewed says so in its log.
  core::Decision decide(const core::DecisionRequest& request) override;
  void notify(const core::PolicyEvent& event) override { current().notify(event); }

  /// Whether the second policy hangs on its thread.
  bool abandoned() const { return second_ && second_->abandoned(); }

 private:
  core::PolicyPort& current() const { return second_ ? *second_ : first_; }

  core::PolicyPort& first_;
  core::TimeNs after_;
  Review review_;
  bool reviewed_ = false;
  std::unique_ptr<host::HostedPolicy> second_;
};

}  // namespace karst::flight
