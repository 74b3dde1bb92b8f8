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

// Files are written under a temporary name and renamed when complete: if the disk is full, the old file or no
// file remains, never a partial one.

/// Writes `stem`.bt (classes) and `stem`.ot (log-odds); throws InputError if writing fails.
void write_octomap(const VoxelMap& map, const std::string& stem);
/// Occupied cells as a binary PLY of points (x y z float32). Throws InputError as above.
void write_ply(const VoxelMap& map, const std::string& path);
/// Reads a .bt or .ot file as read_leaves (octomap_leaves.h) does.
VoxelMap read_octomap(const std::string& path);

}  // namespace karst::core
