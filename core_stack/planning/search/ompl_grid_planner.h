// Our grid search as one of OMPL's planners. Private to planning.
#pragma once
#include <ompl/base/Planner.h>

#include "core_stack/planning/path/path.h"

namespace karst::core {

/// Solves by plan_on_grid; optimal on the grid to within options.heuristic_weight. Start and goal must be
/// clear by options.clearance_m. It proves that there is no way (ABORT), and gives up (TIMEOUT) after
/// options.max_expansions only: a termination condition that is true from the beginning is honoured, later
/// ones are not asked.
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
