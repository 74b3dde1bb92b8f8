// The free space from which a cave is described: where a vehicle can fly, the distance to rock, and the
// volume; from a mesh or from the map of an earlier flight.
#pragma once
#include <functional>
#include <string>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "plugins/simulator/cave/ray_scene.h"
#include "sdk/evaluation/reachable/cell_set.h"

namespace karst::selection {

struct FreeSpaceOptions {
  double resolution_m = 0.2;  // for reading a mesh
  double coarse_m = 0.4;      // edge of the cells used in computations; larger in large caves
  double clearance_m = 0.6;   // least distance to rock where a vehicle can fly, as in evaluation::Reachable
};

struct FreeSpace {
  double resolution_m = 0.4;    // cell k covers [k, k+1) times this
  double clearance_m = 0.6;     // of flyable cells
  evaluation::CellSet flyable;  // coarse cells that contain a place with this clearance; 6-connected
  double volume_m3 = 0;         // includes half of the cells on the rock's surface
  std::function<double(const core::Vec3&)> distance_to_rock;  // metres
  std::function<double(const core::Vec3& from, const core::Vec3& direction)>
      range_to_rock;  // along a unit vector
};

/// `scene` must outlive the result. Throws InputError like evaluation::find_reachable.
FreeSpace free_space_of(const cave::RayScene& scene, const core::Vec3& start, const FreeSpaceOptions& options,
                        const std::string& name);

/// From a map: its known free space; space beyond its frontiers counts as rock. The largest component a
/// vehicle could fly in; `map` must outlive the result. Throws InputError if there is none.
FreeSpace free_space_of(const core::VoxelMap& map, const FreeSpaceOptions& options, const std::string& name);

}  // namespace karst::selection
