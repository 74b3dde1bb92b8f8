// Post-processing: pull the string tight, then push the path away from obstacles towards the preferred
// clearance. Never enters unknown space, never falls below the clearance of the path it was given.
#pragma once
#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/planning/free_space/free_tiles.h"
#include "core_stack/planning/path/path.h"

namespace karst::core {

std::vector<Vec3> refine_path(const VoxelMap& map, const std::vector<Vec3>& points,
                              const PlanningOptions& options);
/// The same on free cells read already: all that are known within two preferred clearances of the path.
std::vector<Vec3> refine_path(const FreeTiles& free, const std::vector<Vec3>& points,
                              const PlanningOptions& options);

}  // namespace karst::core
