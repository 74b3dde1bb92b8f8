// Any planner of OMPL's interface as the search: ours on the grid, RRT-Connect, RRT*, BIT*.
#pragma once
#include "core_stack/planning/roadmap/roadmap.h"

namespace karst::core {

/// A path from `start` to `goal` by the planner that `options.planner` names, every segment clear by
/// `clearance_m` but for the escape; raw: pass it to refine_path. Whether there is a way at all is the
/// roadmap's word, and its way with 10 m around it bounds the space (`roadmap` must be up to date with
/// `map`).
///
/// Planners stop after `options.planner_iterations`, RRT-Connect at its first path. The random seed comes
/// from the query, and one query runs at a time in the process: OMPL's generator of seeds is global. So a
/// query gives the same path always.
Path search_with_ompl(const VoxelMap& map, const Roadmap& roadmap, const Vec3& start, const Vec3& goal,
                      const PlanningOptions& options, double clearance_m);

}  // namespace karst::core
