#include "core_stack/mission/policy/policy_with_fallback.h"

namespace karst::core {
namespace {

/// A vehicle that has been idle for this long, because the policy holds it or none of its goals is
/// acceptable, gets its next goal from the fallback.
constexpr TimeNs kMaxIdle = 2 * kSecond;

}  // namespace

DecidedBy PolicyWithFallback::begin_cycle(TimeNs now) {
  if (explored_ || fallback_found_nothing_) return DecidedBy::policy;
  if (!idle_since_ || now - *idle_since_ < kMaxIdle) return DecidedBy::policy;
  idle_since_.reset();
  return DecidedBy::fallback;
}

PolicyAnswer PolicyWithFallback::ask(const DecisionRequest& request, DecidedBy by) {
  if (failed_ || by == DecidedBy::fallback) return ask_fallback(request);
  PolicyAnswer answer;
  try {
    answer.name = policy_->name();
    answer.decision = policy_->decide(request);
  } catch (const PolicyFailure& failure) {
    failed_ = true;
    answer = ask_fallback(request);
    answer.failure = failure.what();
    return answer;
  }
  output_budget_.trim(answer.decision);
  return answer;
}

PolicyAnswer PolicyWithFallback::ask_fallback(const DecisionRequest& request) {
  return {fallback_.decide(request), DecidedBy::fallback, fallback_.name(), ""};
}

void PolicyWithFallback::notify(const PolicyEvent& event) {
  if (!failed_) policy_->notify(event);
}

}  // namespace karst::core
