// Ways through the free cells of a map.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::survey_export {

/// Whether the straight line leads through free cells only.
bool sees(const core::VoxelMap& map, const core::Vec3& from, const core::Vec3& to);

/// The centre of the nearest free cell within three cells of `p`; `p` itself, if its cell is free.
std::optional<core::Vec3> free_near(const core::VoxelMap& map, const core::Vec3& p);

/// The centres of the cells on a shortest way from `from` to `to`, both in free cells, from face to face: the
/// cells of both ends are the first and the last. None if there is no way in the box around both, widened by
/// `margin_m`.
std::optional<std::vector<core::Vec3>> free_way(const core::VoxelMap& map, const core::Vec3& from,
                                                const core::Vec3& to, double margin_m);

}  // namespace karst::survey_export
