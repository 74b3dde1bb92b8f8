// Path search with planners of OMPL's interface: our grid search, RRT-Connect, RRT*, BIT*.
#pragma once
#include "core_stack/planning/roadmap/roadmap.h"

namespace karst::core {

/// Plans a path from `start` to `goal` with the planner `options.planner`. Every segment but for the escape
/// has the clearance `clearance_m`. The path is raw: pass it to refine_path. The roadmap decides whether
/// there is a path at all, and the box of its path with a margin of 10 m bounds the space (`roadmap` must be
/// up to date with `map`).
///
/// Planners stop after `options.planner_iterations`, RRT-Connect at its first path. The random seed derives
/// from the query, and only one query runs at a time in the process, since OMPL's seed generator is global. A
/// query therefore always gives the same path.
Path search_with_ompl(const VoxelMap& map, const Roadmap& roadmap, const Vec3& start, const Vec3& goal,
                      const PlanningOptions& options, double clearance_m);

}  // namespace karst::core
