// Is there ground to land on below a place, and do others still get by?
#pragma once
#include <optional>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

struct GroundOptions {
  double margin_m = 0.2;      // beyond the vehicle's radius: ground looked at, and air above it
  double max_slope_deg = 15;  // of the plane that fits the ground best
  double max_step_m = 0.25;   // between the highest and the lowest of the ground above that plane
  double max_drop_m = 2.0;    // from the place down to the ground
};

enum class GroundVerdict { good, no_floor, unknown, obstructed, steep, rough };

struct Ground {
  GroundVerdict verdict = GroundVerdict::no_floor;
  Vec3 ground = Vec3::Zero();  // straight below, on top of the floor's cell
  double slope_rad = 0, step_m = 0;
};

/// Looks straight down from `place` in all columns of cells whose centre is within the vehicle's radius and
/// the margin of it, from the cell of `place` on: air that is known to be free, then a cell that is known to
/// be rock. `ground` is valid unless there is no floor below the place itself.
Ground ground_below(const VoxelMap& map, const Vec3& place, double vehicle_radius_m,
                    const GroundOptions& options);

/// A landed vehicle reaches so much farther in another's map than its radius: whole cells are occupied, and
/// it does not stand to the centimetre where it meant to.
constexpr double kAsMapped_m = 0.3;

/// Whether another vehicle can still fly from everywhere to everywhere within the cube of half edge `reach_m`
/// around a landed one whose centre is at `standing`: what was connected within the cube by places clear by
/// `clearance_m`, from one of its faces to another, still is when places within `clearance_m` of the landed
/// vehicle's sphere are taken out.
bool keeps_passage_open(const VoxelMap& map, const Vec3& standing, double vehicle_radius_m,
                        double clearance_m, double radius_m);

}  // namespace karst::core
