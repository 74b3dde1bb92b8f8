// The answer of a policy in one decide(): collected from the sink, checked for form, turned into core types.
//
// Form means finite numbers, bounded counts, readable texts. Mission control judges whether a goal is free,
// reachable and affordable.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "core_stack/mission/policy/policy_port.h"
#include "sdk/abi/karst_abi_policy.h"

namespace karst::host {

constexpr std::uint32_t kMaxGoals = 64;

/// "" if the goal is well formed, otherwise what is wrong with it.
std::string goal_fault(const karst_goal_t& goal);

class DecisionBox {
 public:
  /// Filled through this table while decide() runs.
  karst_decision_sink_t sink();

  /// The reason why the answer as a whole is invalid; "" if it is valid.
  std::string fault() const;
  /// True if the sink refused a call: an error that decide() then returns is the policy's own fault.
  bool misused() const { return !fault_.empty(); }
  /// The goals are stops in order, not alternatives by score (`karst policy check`). Mission control tries
  /// both kinds from the front.
  bool is_tour() const { return tour_; }
  /// The well-formed part of the answer.
  core::Decision decision() const;
  /// Goals left out, with the reason.
  const std::vector<std::pair<core::Goal, std::string>>& refused() const { return refused_; }

 private:
  std::int32_t add(const karst_goal_t* goals, std::uint64_t count, karst_error_t* error);
  std::int32_t set(karst_outcome_t outcome, std::uint32_t flags, const karst_text_t& reason,
                   karst_error_t* error);

  std::vector<core::Goal> goals_;
  std::vector<std::pair<core::Goal, std::string>> refused_;
  std::uint64_t offered_ = 0;
  karst_outcome_t outcome_ = 0;  // 0: not set
  bool tour_ = false;
  std::string reason_, fault_;
};

}  // namespace karst::host
