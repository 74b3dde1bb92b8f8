// Finds the directions near a direction, among many. For LiDARs without rings, whose beams have no neighbours
// by their number.
//
// The sphere is divided into rows of equal height in elevation, and each row into cells of about the same
// width. Directions are sorted by cell, so that the cells of a row around a place are one or two runs of the
// order.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

class DirectionCells {
 public:
  /// Directions are unit vectors. `cell_rad`: height and width of a cell, at least 0.005.
  DirectionCells(std::span<const Vec3f> directions, float cell_rad);

  /// All directions' numbers, sorted by cell; within a cell ascending.
  const std::vector<std::uint32_t>& order() const { return order_; }
  /// Calls visit(first, end) for the runs of `order()` that hold the directions at most `radius_rad` from
  /// `direction`, and some that are farther.
  template <class Visit>
  void for_each_run(const Vec3f& direction, float radius_rad, const Visit& visit) const;
  /// Calls visit(first, end) for each cell's run of `order()` that is not empty.
  template <class Visit>
  void for_each_cell(const Visit& visit) const;

 private:
  struct Row {
    std::size_t first_cell;
    int cells;
  };
  static constexpr float kPi = std::numbers::pi_v<float>;

  int row_of(float elevation_rad) const {
    const int row = static_cast<int>((elevation_rad + kPi / 2) / cell_rad_);
    return std::clamp(row, 0, static_cast<int>(rows_.size()) - 1);
  }
  static int column_of(const Row& row, float azimuth_rad) {
    const float turns = (azimuth_rad + kPi) / (2 * kPi);
    return std::clamp(static_cast<int>(turns * static_cast<float>(row.cells)), 0, row.cells - 1);
  }

  float cell_rad_;
  std::vector<Row> rows_;
  std::vector<std::uint32_t> begin_;  // of each cell in order_, and the end of the last
  std::vector<std::uint32_t> order_;
};

template <class Visit>
void DirectionCells::for_each_run(const Vec3f& d, float radius_rad, const Visit& visit) const {
  const float elevation = std::asin(std::clamp(d.z(), -1.0f, 1.0f)), azimuth = std::atan2(d.y(), d.x());
  const int low = row_of(elevation - radius_rad), high = row_of(elevation + radius_rad);
  for (int r = low; r <= high; ++r) {
    const Row& row = rows_[static_cast<std::size_t>(r)];
    const auto run = [&](int first, int last) {
      visit(begin_[row.first_cell + static_cast<std::size_t>(first)],
            begin_[row.first_cell + static_cast<std::size_t>(last) + 1]);
    };
    // A cap of this radius spans asin(sin(radius) / cos(elevation of its centre)) of azimuth on either side.
    const float sine = std::sin(radius_rad) / std::max(std::cos(elevation), 1e-3f);
    const float half = sine >= 1 ? kPi : std::asin(sine);
    const int columns = static_cast<int>(half / (2 * kPi) * static_cast<float>(row.cells)) + 1;
    if (2 * columns + 1 >= row.cells) {
      run(0, row.cells - 1);
      continue;
    }
    const int middle = column_of(row, azimuth), first = middle - columns, last = middle + columns;
    run(std::max(first, 0), std::min(last, row.cells - 1));
    if (first < 0) run(first + row.cells, row.cells - 1);
    if (last >= row.cells) run(0, last - row.cells);
  }
}

template <class Visit>
void DirectionCells::for_each_cell(const Visit& visit) const {
  for (std::size_t c = 0; c + 1 < begin_.size(); ++c)
    if (begin_[c] < begin_[c + 1]) visit(begin_[c], begin_[c + 1]);
}

}  // namespace karst::core
