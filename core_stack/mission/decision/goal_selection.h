// Selects from a ranked list of goals the first that the vehicle can fly to and return home from.
//
// A goal must lie in known free space with clearance from rock and unknown cells, at a place that is not
// closed. There must be a path to it that climbs no steeper than the sensors see, and the flight there and
// home must leave the reserve. It runs on the map lane.
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
  std::optional<Goal> goal;  // with `path` to it; nothing if all tried were rejected
  Path path;
  std::vector<RejectedGoal> rejected;  // those before it in the list
  bool all_too_far = false;            // every one was rejected for its distance
  bool more_to_try = false;            // in the next cycle, when the rejected places are closed
};

class GoalSelection {
 public:
  /// `world`, `home` and `ledger` must outlive it. Closes unreachable places in the ledger.
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
