// How much room there is around the vehicle, by the map: along the path it flies, around its hull, below a
// roof, and beside the path flown.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/planning/path/path.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

/// What a flight's clearances are measured by.
struct ClearanceLimits {
  double usual_m = 0;            // of a path
  bool narrow_passages = false;  // may be flown, with less
  double hull_radius_m = 0;
  double ground_z_m = 0;  // of the vehicle where it starts: its hull touches the ground there
};
ClearanceLimits clearance_limits(const PlanningOptions& options, const VehicleDescription& vehicle);

/// Index of the first segment of `points` nearer to an obstacle's cell than the vehicle's radius, or -1.
int touching_segment(const VoxelMap& map, const ClearanceLimits& limits, const std::vector<Vec3>& points);

/// Index of the first segment of `points` that the map now forbids, or -1. Near the `narrow_places` of the
/// path it allows for less clearance.
int blocked_segment(const VoxelMap& map, const ClearanceLimits& limits, const std::vector<Vec3>& points,
                    const std::vector<Vec3>& narrow_places);

/// Distance of the vehicle's hull at `p` from the nearest obstacle's cell; nothing if that is far.
std::optional<double> hull_clearance_m(const VoxelMap& map, const ClearanceLimits& limits, const Vec3& p);

/// Where to hover straight below `highest`: as high as the usual clearance above and below allows, or with
/// the most room above and below where there is not so much.
Vec3 hover_below(const VoxelMap& map, const ClearanceLimits& limits, const Vec3& highest);

/// Poses flown, from the last to the first, without the loops that the map shows a clear line across.
std::vector<Vec3> flown_back(const VoxelMap& map, const ClearanceLimits& limits,
                             const std::vector<Vec3>& flown);

}  // namespace karst::core
