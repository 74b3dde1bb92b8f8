// The map as an octomap::OcTree, for storage (map.bt, map.ot) and for tools that read OctoMap.
#pragma once
#include <memory>
#include <string>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace octomap {
class OcTree;
}

namespace karst::core {

/// A pruned tree with the same log-odds in every known cell (built in Morton order).
std::unique_ptr<octomap::OcTree> to_octree(const VoxelMap& map);

// A file is written under a temporary name and renamed when it is complete: a full disk leaves the old file,
// or none, but never half of one.

/// Writes `stem`.bt (classes) and `stem`.ot (log-odds); throws InputError when the disk refuses.
void write_octomap(const VoxelMap& map, const std::string& stem);
/// Occupied cells as a binary PLY of points (x y z float32). Throws InputError as above.
void write_ply(const VoxelMap& map, const std::string& path);
/// Reads a .bt or .ot file (its first line says which); throws InputError when it is truncated, damaged or no
/// such file. A .bt file holds classes only: its cells get the clamping values of MapOptions' defaults.
VoxelMap read_octomap(const std::string& path);

}  // namespace karst::core
