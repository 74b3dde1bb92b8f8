// Merges occupancy maps: log-odds of independent observations add.
#pragma once
#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::map_merge {

/// Adds `source`, transformed, to `target`: each cell of `target` whose centre lies in a known cell of
/// `source` gets that cell's log-odds added, clamped to the probabilities of `options`. The edge lengths of
/// the cells must agree to 1 %.
void add_map(core::VoxelMap& target, const core::VoxelMap& source, const core::Pose& T_target_source,
             const core::MapOptions& options);

}  // namespace karst::map_merge
