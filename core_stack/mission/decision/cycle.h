// The input and the result of a decision cycle.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core_stack/mission/decision/frontier_offers.h"
#include "core_stack/mission/policy/policy_port.h"
#include "core_stack/mission/policy/policy_with_fallback.h"
#include "core_stack/team/team_node.h"

namespace karst::core {

struct CycleInput {
  TimeNs now = 0, deadline = 0;
  State state;               // expected at the deadline
  Vec3 from = Vec3::Zero();  // where the new path begins: the end of the committed segment
  Vec3 direction = Vec3::UnitX();
  double seconds_left = 0;  // of flight, limited by battery and mission time
  double battery_fraction = 0, battery_seconds_left = 0, mission_seconds_left = 0;  // for the policy
  double flown_length_m = 0;     // stands for the path home where the map shows none
  std::vector<Vec3> flown_path;  // from take-off to `from`
  GoalFate last_fate = GoalFate::none;
  std::optional<Goal> last_goal;
  bool standing = false;                 // no goal is being flown to
  bool appending = false;                // the new path follows the last goal
  std::vector<PolicyEvent> events;       // since the last cycle
  std::vector<TeammateState> teammates;  // empty without a team
  std::vector<std::uint32_t> looked_at;  // frontiers reached or seen in passing since the last cycle
  /// Whether it is the mission's maximum flight time that ends the flight, rather than the battery.
  bool limited_by_time() const { return mission_seconds_left < battery_seconds_left; }
};

struct RejectedGoal {
  Goal goal;
  std::string reason;
};

struct CycleResult {
  Outcome outcome = Outcome::hold;
  bool out_of_time = false;  // the reason why nothing is left to explore
  std::string reason, policy;
  DecidedBy decided_by = DecidedBy::policy;
  std::optional<Goal> goal;  // accepted, with `path` from CycleInput::from to it
  Path path;
  std::vector<RejectedGoal> rejected;
  std::vector<UnseenFrontier> unseen;  // those reported for the first time
  std::vector<Drawing> drawings;
  std::vector<std::string> drawing_texts;  // the same, serialized as fields of events
  std::vector<std::string> log;
  std::string policy_failure;  // set if it failed in this cycle: the fallback takes over
  std::size_t goals_proposed = 0;
  std::vector<FrontierCluster> frontiers;  // as offered, without cells; for the report
  double decide_ms = 0, plan_ms = 0;       // wall clock, for timing.json only
};

}  // namespace karst::core
