#include "sdk/flight/successive_policies.h"

#include <utility>

namespace karst::flight {

core::Decision SuccessivePolicies::decide(const core::DecisionRequest& request) {
  if (reviewed_ || request.stamp < after_) return current().decide(request);
  reviewed_ = true;
  Successor next = review_(request);
  const std::string before = first_.name();
  second_ = std::move(next.policy);
  core::Decision decision = current().decide(request);
  decision.log.insert(decision.log.begin(),
                      (second_ ? "the policy is " + second_->name() + " from here on, after " + before
                               : "the policy stays " + before) +
                          (next.reason.empty() ? "" : ": " + next.reason));
  return decision;
}

}  // namespace karst::flight
