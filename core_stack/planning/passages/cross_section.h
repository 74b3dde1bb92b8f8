// How wide and how high the free space of a map is at a place.
#pragma once
#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// Lines are followed this far to either side.
constexpr double kMostReach_m = 50.0;

/// Length of the ray from `from` (in a free cell) along the unit vector `d` until it leaves the free cells. A
/// single unknown cell between free ones is a gap between measured rays, and is passed. At most kMostReach_m.
double free_reach_m(const VoxelMap& map, const Vec3& from, const Vec3& d);

struct CrossSection {
  Vec3 center = Vec3::Zero();
  double width_m = 0;   // the shortest of ten horizontal lines through the centre
  double height_m = 0;  // the vertical line through it
};

/// The cross-section at `from`, which lies in a free cell, or near it: its centre is moved between the walls,
/// and between floor and ceiling, by `most_m` at most each.
CrossSection cross_section(const VoxelMap& map, const Vec3& from, double most_m);

}  // namespace karst::core
