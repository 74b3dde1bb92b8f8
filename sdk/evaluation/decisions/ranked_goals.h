// The goals of a decision, best first, with what became of each.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sdk/evaluation/decisions/decision_record.h"

namespace karst::evaluation {

/// An answer of the policy as the host records it (sdk/host/serialization/request_log.h).
struct RecordedAnswer {
  std::uint32_t request = 0;  // its number: 1, 2, ...
  double stamp_s = 0;         // when it was made
  std::string answer;         // JSON
};

struct RankedGoal {
  core::Vec3 position = core::Vec3::Constant(core::event::kUnknown);
  double score = core::event::kUnknown;
  double max_speed_mps = 0;    // 0: the mission's, or not recorded
  std::uint32_t frontier = 0;  // 0: none
  std::string why, fate;       // "accepted", "refused: it lies in unknown space", "not tried", ...
};

/// An answer as read.
struct JudgedAnswer {
  std::string failure;  // of the policy; the rest is then empty
  std::string outcome, reason;
  std::vector<RankedGoal> goals;
};

/// Nothing if the answer has another shape.
std::optional<JudgedAnswer> judged(const RecordedAnswer& answer, const DecisionRecord& decision);

/// The goals that have events, in the order in which they were tried: those refused, then the accepted one.
std::vector<RankedGoal> tried_goals(const DecisionRecord& decision);

/// Whether the fallback proposed it: the goals of a decision may be those of the policy and, behind them,
/// its.
bool is_of_fallback(const RankedGoal& goal);

}  // namespace karst::evaluation
