// The planner as mission control uses it: searches, refines, and checks every segment.
#pragma once
#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/planning/path/path.h"
#include "core_stack/planning/roadmap/roadmap.h"

namespace karst::core {

/// Plans with the planner options.planner. `grid` uses the grid search for near goals and the roadmap for far
/// ones (or where the grid search gives up); all others use search_with_ompl. The returned path is refined
/// and can be flown: every segment except for the leading `escape_points` has the clearance
/// options.clearance_m.
///
/// Where a passage is too narrow for the full clearance and there is no path around it, the path has the
/// search clearance (search_clearance_m), and Path::narrow_places lists these places.
///
/// The searches may squeeze (plan_on_grid_squeezing); refining moves the path to the full clearance. Where
/// that fails, the grid is searched without squeezing.
Path plan(const VoxelMap& map, const Roadmap& roadmap, const Vec3& start, const Vec3& goal,
          const PlanningOptions& options);

/// The same for an existing raw path with the search clearance, such as a path home.
Path plan_along(const VoxelMap& map, const Roadmap& roadmap, const Path& raw, const PlanningOptions& options);

/// Marks the places of a path, after its escape, that lack the clearance `clearance_m`.
void mark_narrow_places(const VoxelMap& map, double clearance_m, Path& path);

}  // namespace karst::core
