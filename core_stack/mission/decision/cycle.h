// One decision cycle as values: what it starts from, and what it comes to.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core_stack/mission/decision/frontier_offers.h"
#include "core_stack/mission/policy/policy_port.h"
#include "core_stack/team/team_node.h"

namespace karst::core {

/// What a decision cycle starts from.
struct CycleInput {
  TimeNs now = 0, deadline = 0;
  State state;               // expected at the deadline
  Vec3 from = Vec3::Zero();  // where the new path begins: the end of the stretch already committed to
  Vec3 direction = Vec3::UnitX();
  double seconds_left = 0;       // of flight, by the battery and by the mission's time limit
  double flown_length_m = 0;     // length of the flown path: that of the path home where the map shows none
  std::vector<Vec3> flown_path;  // the flown path, all of it, up to `from`
  GoalFate last_fate = GoalFate::none;
  std::optional<Goal> last_goal;
  bool standing = false;                 // nothing is under way
  bool appending = false;                // the last goal will be reached before the new one is flown to
  std::vector<PolicyEvent> events;       // since the last cycle
  std::vector<TeammateState> teammates;  // the others of a team
  std::vector<std::uint32_t> looked_at;  // frontiers reached, or seen in passing, since the last cycle
};

struct RejectedGoal {
  Goal goal;
  std::string reason;
};

/// What a decision cycle comes to.
struct CycleResult {
  Outcome outcome = Outcome::hold;
  bool out_of_time = false;  // that is why nothing is left to explore
  std::string reason, policy;
  std::optional<Goal> goal;  // accepted, with `path` from CycleInput::from to it
  Path path;
  std::vector<RejectedGoal> rejected;
  std::vector<UnseenFrontier> unseen;  // for the first time in this cycle
  std::vector<Drawing> drawings;
  std::vector<std::string> drawing_texts;  // the same as fields of events, made by mission control
  std::vector<std::string> log;
  std::string policy_failure;  // if it failed in this cycle: the fallback takes over
  std::size_t goals_proposed = 0;
  std::vector<FrontierCluster> frontiers;  // as offered, without their cells: for the report
  double decide_ms = 0, plan_ms = 0;       // wall clock, for timing.json only
};

}  // namespace karst::core
