// Ways through the free cells of a map.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// Whether the straight line leads through free cells only.
bool sees(const VoxelMap& map, const Vec3& from, const Vec3& to);

/// The centre of the nearest free cell within three cells of `p`; `p` itself, if its cell is free.
std::optional<Vec3> free_near(const VoxelMap& map, const Vec3& p);

/// The centres of the cells on a shortest way from `from` to `to`, both in free cells, from face to face: the
/// cells of both ends are the first and the last. None if there is no way in the box around both, widened by
/// `margin_m`, or a search of `most_cells` found none.
std::optional<std::vector<Vec3>> free_way(const VoxelMap& map, const Vec3& from, const Vec3& to,
                                          double margin_m, std::size_t most_cells);

}  // namespace karst::core
