// From a ranked list of goals, the first that the vehicle can fly to, and come home from.
//
// A goal must lie in known free space, clear of rock and of what is unknown, at a place that is not closed;
// there must be a path to it that climbs no steeper than the sensors look; and flying there and home must
// leave the reserve. It lives on the map lane.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core_stack/mission/decision/cycle.h"
#include "core_stack/mission/decision/goal_ledger.h"
#include "core_stack/mission/decision/visibility.h"
#include "core_stack/mission/world_model/home_estimator.h"
#include "core_stack/mission/world_model/world_model.h"

namespace karst::core {

struct GoalQuery {
  const ClearanceRoadmap* roadmap = nullptr;  // up to date; paths are planned on it
  const CycleInput* input = nullptr;
  ClosureRules rules;  // by which the goals were offered
};

struct GoalChoice {
  std::optional<Goal> goal;  // with `path` to it; nothing if none of those tried will do
  Path path;
  std::vector<RejectedGoal> rejected;  // those before it in the list
  bool all_too_far = false;            // that is why they were rejected, each of them
  bool more_to_try = false;            // in the next cycle: the places of those rejected are closed by then
};

class GoalSelection {
 public:
  /// `world`, `home` and `ledger` outlive it. Places that no path was found to are closed in the ledger.
  GoalSelection(const CoreOptions& options, const VehicleDescription& vehicle, const WorldModel& world,
                HomeEstimator& home, GoalLedger& ledger);

  GoalChoice choose(const GoalQuery& query, const std::vector<Goal>& goals);

 private:
  std::optional<std::string> objection(const GoalQuery& query, const Goal& goal) const;
  bool affordable(const CycleInput& input, const Goal& goal, const Path& path) const;

  MotionLimits motion_;
  SteepestView view_;
  const WorldModel* world_;
  HomeEstimator* home_;
  GoalLedger* ledger_;
};

}  // namespace karst::core
