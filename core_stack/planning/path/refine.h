// Path post-processing: shortens the path to a taut string, moves it away from obstacles towards the
// preferred clearance, and rounds its corners. It never enters unknown space and never falls below the
// clearance of the given path.
#pragma once
#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/planning/free_space/free_tiles.h"
#include "core_stack/planning/path/path.h"

namespace karst::core {

std::vector<Vec3> refine_path(const VoxelMap& map, const std::vector<Vec3>& points,
                              const PlanningOptions& options);
/// The same on `free`, which must hold all known cells within two preferred clearances of the path.
std::vector<Vec3> refine_path(const FreeTiles& free, const std::vector<Vec3>& points,
                              const PlanningOptions& options);

}  // namespace karst::core
