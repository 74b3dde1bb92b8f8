// Our grid search as one of OMPL's planners. Private to planning.
#pragma once
#include <ompl/base/Planner.h>

#include "core_stack/planning/path/path.h"

namespace karst::core {

/// Solves by plan_on_grid; optimal on the grid to within options.heuristic_weight. Start and goal must be
/// clear by options.clearance_m. It proves that there is no path (ABORT), and gives up (TIMEOUT) only after
/// options.max_expansions: it checks the termination condition at the start, and not again.
class OmplGridPlanner : public ompl::base::Planner {
 public:
  OmplGridPlanner(const ompl::base::SpaceInformationPtr& si, const VoxelMap& map,
                  const PlanningOptions& options);
  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& stop) override;

 private:
  const VoxelMap& map_;
  PlanningOptions options_;
};

}  // namespace karst::core
