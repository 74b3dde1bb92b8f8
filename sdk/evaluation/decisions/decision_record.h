// One decision of a flight, out of its record: what was offered, which goals were judged, and what became of
// the goal that the vehicle flew to.
//
// events.jsonl has the goals that were accepted or refused. The goals behind the accepted one were never
// tried and have no event; they stand in the policy's answer, which only `karst fly --record-requests` keeps.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

/// The policy that steps in where no goal of the flight's own was acceptable, or where that one failed.
inline constexpr const char* kFallback = "fallback";

/// A goal that was flown to, from when it was accepted.
struct FlownGoal {
  double accepted_s = 0;
  std::optional<core::Vec3> position;
  int planned_anew = 0;           // times that it was accepted again, on another path
  std::optional<double> until_s;  // none: the record ends before
  std::string fate, reason;
};

struct DecisionRecord {
  std::size_t number = 0, of = 0;  // 1, 2, ... of the flight's decisions
  double t_s = 0;                  // when it took effect
  double previous_s = 0;           // when the decision before it did; -inf for the first
  std::string phase;               // "" if unknown
  std::string flown_policy;        // the flight's own, also where the fallback decided; "" if unknown
  bool policy_failed = false;      // for good, in this decision or before it
  core::event::Decision decision;
  std::vector<core::event::Goal> refused;  // in the order in which they were tried
  std::optional<core::event::Goal> accepted;
  std::optional<FlownGoal> flown;  // the accepted goal, or else the one that was under way
  std::vector<core::event::Cluster> offered;
  std::vector<core::event::Frontier> unseen;  // first found in it to be out of the sensors' view
  std::optional<core::Vec3> vehicle;          // where it estimated to be
};

/// All decisions of a flight, in its order.
std::vector<DecisionRecord> decisions_of(const RunRecord& run);

/// The last decision at `t_s` or before it, give or take the half of a hundredth that a clock rounds away;
/// nothing if there is none.
std::optional<DecisionRecord> decision_at(const RunRecord& run, double t_s);

/// Whether a request of this time was made for the decision: a decision takes effect some time after its
/// requests, and none is made before the decision before it took effect.
bool was_asked_for(const DecisionRecord& decision, double request_s);

}  // namespace karst::evaluation
