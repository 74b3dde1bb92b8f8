// Visibility checks of straight lines in the map, for the homing tree.
#pragma once
#include "core_stack/homing/path_home/homing_tree.h"
#include "core_stack/planning/roadmap/roadmap.h"

namespace karst::core {

/// Whether a line is known to be free with clearance `clearance_m`, as of the roadmap's last update. Keeps a
/// reference.
FreeRay free_rays(const Roadmap& roadmap, double clearance_m);

/// Whether an occupied cell's centre is nearer to the line than `clearance_m`. This revokes a free ray;
/// unknown cells do not. Keeps a reference.
FreeRay rock_rays(const VoxelMap& map, double clearance_m);

}  // namespace karst::core
