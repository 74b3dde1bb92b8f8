// Planning as mission control calls it: search, refine, and a last look at every segment.
#pragma once
#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/planning/path/path.h"
#include "core_stack/planning/roadmap/roadmap.h"

namespace karst::core {

/// By the planner that options.planner names. `grid`: near goals by grid search, far ones (or where the grid
/// search gives up) by the roadmap; others: search_with_ompl. Whatever found it, the path is
/// refined and flyable as it stands: every segment is clear at options.clearance_m, but for the leading
/// `escape_points`.
///
/// A passage too narrow for the whole clearance, without a way around it, is flown through with the search's
/// (search_clearance_m); Path::narrow_places says where.
///
/// The searches may squeeze (plan_on_grid_squeezing), refining lifts the path to the full clearance, and
/// where that fails the grid is searched without squeezing.
Path plan(const VoxelMap& map, const Roadmap& roadmap, const Vec3& start, const Vec3& goal,
          const PlanningOptions& options);

/// The same from a path found already: raw, of the search's clearance, such as the way home.
Path plan_along(const VoxelMap& map, const Roadmap& roadmap, const Path& raw, const PlanningOptions& options);

/// Notes the places of a path, behind its escape, that are not clear by `clearance_m`.
void mark_narrow_places(const VoxelMap& map, double clearance_m, Path& path);

}  // namespace karst::core
