// Which cells of a grid hold points: what a straight line meets.
#pragma once
#include <unordered_set>
#include <vector>

#include "core_stack/mapping/occupancy/packed_cell.h"

namespace karst::from_cloud {

class OccupiedCells {
 public:
  /// Coordinates must be below core::kPackedLimit cells, here and below.
  OccupiedCells(const std::vector<core::Vec3f>& points, double cell_m);

  double cell_m() const { return cell_m_; }
  /// Whether the line from one place to the other passes a cell that holds a point.
  bool block(const core::Vec3& from, const core::Vec3& to) const;

 private:
  double cell_m_;
  std::unordered_set<core::PackedCell> cells_;  // never iterated
};

}  // namespace karst::from_cloud
