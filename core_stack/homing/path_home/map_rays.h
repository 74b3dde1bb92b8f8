// The map's answers about straight lines, for the homing tree.
#pragma once
#include "core_stack/homing/path_home/homing_tree.h"
#include "core_stack/planning/roadmap/roadmap.h"

namespace karst::core {

/// Known free, and clear by `clearance_m`, as of the roadmap's last update. Keeps a reference.
FreeRay free_rays(const Roadmap& roadmap, double clearance_m);

/// Some occupied cell's centre is nearer to the line than `clearance_m`: what takes a ray back that was free
/// once. Unknown cells do not. Keeps a reference.
FreeRay rock_rays(const VoxelMap& map, double clearance_m);

}  // namespace karst::core
