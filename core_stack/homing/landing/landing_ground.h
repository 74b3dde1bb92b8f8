// Checks whether there is ground to land on below a position, and whether others can still pass.
#pragma once
#include <optional>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

struct GroundOptions {
  double margin_m = 0.2;      // beyond the vehicle's radius, of the ground and of the air above it
  double max_slope_deg = 15;  // of the plane fitted to the ground
  double max_step_m = 0.25;   // between the highest and lowest ground relative to that plane
  double max_drop_m = 2.0;    // from the position down to the ground
};

enum class GroundVerdict { good, no_floor, unknown, obstructed, steep, rough };

struct Ground {
  GroundVerdict verdict = GroundVerdict::no_floor;
  Vec3 ground = Vec3::Zero();  // straight below, on top of the floor's cell
  double slope_rad = 0, step_m = 0;
};

/// Scans down from `place` in every column of cells whose centre lies within the vehicle's radius plus the
/// margin: each must hold known free cells from the height of `place` down to an occupied cell. `ground` is
/// valid unless there is no floor below `place` itself.
Ground ground_below(const VoxelMap& map, const Vec3& place, double vehicle_radius_m,
                    const GroundOptions& options);

/// How much larger than its radius a landed vehicle appears in another's map: whole cells are occupied, and
/// it stands a few centimetres off its intended position.
constexpr double kAsMapped_m = 0.3;

/// Whether connectivity is preserved within the cube of half edge `radius_m` around a landed vehicle whose
/// centre is at `standing`: faces of the cube that were connected by cells with clearance `clearance_m` stay
/// connected when all cells within `clearance_m` of the landed vehicle's sphere are removed.
bool keeps_passage_open(const VoxelMap& map, const Vec3& standing, double vehicle_radius_m,
                        double clearance_m, double radius_m);

}  // namespace karst::core
