// The free space a cave is described from: where a vehicle can fly, how far the rock is, and how much room
// there is; of a mesh or of the map of an earlier flight.
#pragma once
#include <functional>
#include <string>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "plugins/simulator/cave/ray_scene.h"
#include "sdk/evaluation/reachable/cell_set.h"

namespace karst::selection {

struct FreeSpaceOptions {
  double resolution_m = 0.2;  // of what is read from a mesh
  double coarse_m = 0.4;      // edge of the cells that are worked with; more in large caves
  double clearance_m = 0.6;   // least distance to rock where a vehicle can fly, as in evaluation::Reachable
};

struct FreeSpace {
  double resolution_m = 0.4;    // cell k covers [k, k+1) times this
  double clearance_m = 0.6;     // of flyable cells
  evaluation::CellSet flyable;  // coarse cells that hold a place with this clearance; one 6-connected part
  double volume_m3 = 0;         // with half of the cells the rock's surface runs through
  std::function<double(const core::Vec3&)> distance_to_rock;  // metres
  std::function<double(const core::Vec3& from, const core::Vec3& direction)>
      range_to_rock;  // along a unit vector
};

/// `scene` must outlive the result. Throws InputError as evaluation::find_reachable does.
FreeSpace free_space_of(const cave::RayScene& scene, const core::Vec3& start, const FreeSpaceOptions& options,
                        const std::string& name);

/// Of a map: what is known to be free; what lies beyond its frontiers counts as rock. The largest part a
/// vehicle could fly in; `map` must outlive the result. Throws InputError if there is none.
FreeSpace free_space_of(const core::VoxelMap& map, const FreeSpaceOptions& options, const std::string& name);

}  // namespace karst::selection
