// The cave from above: for each column of cells, whether any of them can be flown in or seen.
#pragma once
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"
#include "sdk/evaluation/reachable/cell_set.h"

namespace karst::preflight {

/// `length` columns side by side towards the east, from column (x, y) on; column k covers [k, k+1) * edge_m.
struct ColumnRun {
  int x = 0, y = 0, length = 0;
};

struct PlanView {
  double edge_m = 0.2;
  std::vector<ColumnRun> runs;  // from south to north, and from west to east
  core::Vec3 start = core::Vec3::Zero();
};

/// Columns are joined to larger ones where the cave is large, so that the picture stays small.
PlanView plan_view(const evaluation::CellSet& cells, double resolution_m, const core::Vec3& start);

/// An SVG element with north at the top, a scale bar and the start; at most 180 x 110 mm. "" without columns.
std::string to_svg(const PlanView& plan);

}  // namespace karst::preflight
