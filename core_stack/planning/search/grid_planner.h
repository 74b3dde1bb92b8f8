// 26-connected A* over known-free cells; a cell is feasible if no obstacle's centre is nearer than the
// clearance to the cell's centre.
#pragma once
#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/planning/free_space/free_tiles.h"
#include "core_stack/planning/path/path.h"

namespace karst::core {

/// Unknown space is never assumed to be free. If the start itself lacks the clearance (the map has changed,
/// or the vehicle was pushed), the path may first escape through free cells of increasing clearance. The
/// result is raw: pass it to refine_path.
Path plan_on_grid(const VoxelMap& map, const Vec3& start, const Vec3& goal, const PlanningOptions& options);

/// The same, but also uses cells in which a point half a cell from the centre is clear: centres sample space
/// at the resolution only, and the middle of a narrow passage may lie between two of them. The raw path has
/// the clearance search_clearance_m; refine_path moves it to the full clearance.
Path plan_on_grid_squeezing(const VoxelMap& map, const Vec3& start, const Vec3& goal,
                            const PlanningOptions& options);

/// The planner's feasibility test: p's cell is free, and no obstacle's centre is nearer than the clearance.
/// False if p is not finite.
bool is_clear(const VoxelMap& map, const Vec3& p, double clearance_m);
/// Whether every point of the segment is clear.
bool segment_clear(const VoxelMap& map, const Vec3& a, const Vec3& b, double clearance_m,
                   Confined confined = Confined::yes);
/// Index of the first segment of `points` that is not clear, or -1.
int first_blocked_segment(const VoxelMap& map, const std::vector<Vec3>& points, double clearance_m,
                          Confined confined = Confined::yes);

}  // namespace karst::core
