// The map as points for the report: the shown cells, their times, and their surface normals.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "sdk/evaluation/record/map_growth.h"
#include "sdk/evaluation/record/poses.h"

namespace karst::evaluation {

struct Cloud {
  double cell_m = 0;                 // edge of a point's cell: the map's, or twice, four times ... that
  std::vector<OccupiedSpan> points;  // keys in units of cell_m
  std::vector<std::array<std::int8_t, 3>> normals;  // 127 * unit normal, towards the observing vehicle
};

/// At most `max_points` cells no smaller than `min_cell_m`, by merging 2x2x2 cells as often as needed: a
/// merged cell exists while any part does. Cells that existed for less than `flicker_ms` are left out.
Cloud make_cloud(const std::vector<OccupiedSpan>& growth, double resolution_m, std::size_t max_points,
                 const std::vector<StampedPose>& seen_from, double min_cell_m = 0,
                 std::int32_t flicker_ms = 2000);

}  // namespace karst::evaluation
