// Where a surveyor would put stations on a middle line: at its ends, at bends, where its size changes, and at
// most so far apart; each sees the next.
#pragma once
#include <cstddef>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "sdk/survey_export/middle_line.h"

namespace karst::survey_export {

struct StationOptions {
  double longest_leg_m = 10.0;
  /// A point of the line may be so far from the straight leg past it: a part of the passage's width, or this.
  double least_bend_m = 0.15, bend_fraction = 0.04;
  /// So may its width and height be from those between the two stations.
  double least_change_m = 1.0, change_fraction = 0.35;
};

/// Indices of points of the line, the first and the last among them, with the fewest legs, and of those the
/// legs that are least off the line; of equal ones the most even. A leg joins two neighbouring points if
/// nothing else will do.
std::vector<std::size_t> stations_on(const core::VoxelMap& map, const MiddleLine& line,
                                     const StationOptions& options);

}  // namespace karst::survey_export
