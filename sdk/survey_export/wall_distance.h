// What a surveyor measures at a station: the distances to the rock around it.
#pragma once
#include <optional>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "sdk/survey/survey.h"

namespace karst::survey_export {

constexpr double kMostWall_m = 100.0;

/// From `from`, in a free cell, along the unit vector `d` to the middle of the first occupied cell's part of
/// the ray: rock that was hit lies anywhere in its cell. A single unknown cell is a gap between rays, and is
/// passed. None if the ray comes to unknown space, or farther than kMostWall_m.
std::optional<double> wall_distance_m(const core::VoxelMap& map, const core::Vec3& from, const core::Vec3& d);

/// Whether the ray from `from` along `d`, `distance_m` long, looks along another passage instead of across
/// its own: three quarters on, it is within 45 degrees of a leg's direction, nearer to that leg than half as
/// far as it came, and in sight of it. At a junction, such a ray gives no width.
bool runs_along_leg(const core::VoxelMap& map, const survey::Survey& survey, const core::Vec3& from,
                    const core::Vec3& d, double distance_m);

/// Without the distances whose rays run along a leg.
survey::Dimensions across_passage(const core::VoxelMap& map, const survey::Survey& survey,
                                  const core::Vec3& station, const core::Vec3& facing,
                                  survey::Dimensions dimensions);

/// Left and right across `facing` (level, of unit length), up and down; none where nothing was seen.
survey::Dimensions dimensions_at(const core::VoxelMap& map, const core::Vec3& station,
                                 const core::Vec3& facing);

}  // namespace karst::survey_export
