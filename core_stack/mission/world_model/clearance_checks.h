// Clearance checks against the map: along the path ahead, around the hull, below a roof, and beside the flown
// path.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/planning/free_space/free_tiles.h"
#include "core_stack/planning/path/path.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

/// The clearances that a flight must keep.
struct ClearanceLimits {
  double usual_m = 0;            // of a path
  bool narrow_passages = false;  // whether they may be flown, with less clearance
  double hull_radius_m = 0;
  double ground_z_m = 0;  // of the vehicle's centre when standing at the start
};
ClearanceLimits clearance_limits(const PlanningOptions& options, const VehicleDescription& vehicle);

/// Index of the first segment of `points` within the vehicle's radius of an obstacle cell, or -1. A
/// region's border is no obstacle: the flown path back from outside must lead over it.
int touching_segment(const VoxelMap& map, const ClearanceLimits& limits, const std::vector<Vec3>& points);

/// Index of the first segment of `points` that lacks clearance in the current map, or -1. Near the path's
/// `narrow_places` less clearance is required.
int blocked_segment(const VoxelMap& map, const ClearanceLimits& limits, const std::vector<Vec3>& points,
                    const std::vector<Vec3>& narrow_places);

/// Distance of the vehicle's hull at `p` from the nearest obstacle cell, or also from the border of the map's
/// region; nothing if that is far.
std::optional<double> hull_clearance_m(const VoxelMap& map, const ClearanceLimits& limits, const Vec3& p,
                                       Confined confined = Confined::no);

/// Where to hover straight below `highest`: as high as the usual clearance above and below allows, or halfway
/// between floor and roof where there is less room.
Vec3 hover_below(const VoxelMap& map, const ClearanceLimits& limits, const Vec3& highest);

/// The flown path reversed, with loops cut where the map shows a clear line.
std::vector<Vec3> flown_back(const VoxelMap& map, const ClearanceLimits& limits,
                             const std::vector<Vec3>& flown);

}  // namespace karst::core
