// Traverses the cells of a segment face by face (Amanatides and Woo, A Fast Voxel Traversal Algorithm, 1987).
//
// Which axis is crossed next cannot be predicted, so the step has no branch: times are integers, and masks
// select the increments. One unit of time is 2^-60 of the segment. An axis crosses its last border no later
// than kEnd and would cross the next one after kEnd. This holds exactly, so the walk always ends in the end's
// cell despite rounding.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core_stack/mapping/occupancy/packed_cell.h"

namespace karst::core {

class CellWalk {
 public:
  /// The segment in units of cells (metres divided by the resolution), within +-kPackedLimit.
  CellWalk(const Vec3& from, const Vec3& to)
      : x_(from.x(), to.x(), kShiftX), y_(from.y(), to.y(), kShiftY), z_(from.z(), to.z(), 0) {
    cell_ = pack({x_.first, y_.first, z_.first});
  }

  PackedCell cell() const { return cell_; }
  /// Number of steps from the first cell to the last.
  std::int32_t steps() const { return x_.crossings + y_.crossings + z_.crossings; }
  /// Must be called at most steps() times.
  void advance() {
    const std::int64_t x_first = mask_less(x_.time, y_.time) & mask_less(x_.time, z_.time);
    const std::int64_t y_first = mask_less(y_.time, z_.time) & ~x_first;
    cell_ += x_.cross(x_first) + y_.cross(y_first) + z_.cross(~(x_first | y_first));
  }

 private:
  /// All ones if a < b, else zero; times stay below 2^62, so the difference does not overflow.
  static std::int64_t mask_less(std::int64_t a, std::int64_t b) { return (a - b) >> 63; }

  struct Axis {
    static constexpr std::int64_t kEnd = std::int64_t{1} << 60;
    std::int64_t time = 2 * kEnd, period = 0;  // of the next crossing; time between crossings
    PackedCell step = 0;
    std::int32_t first, crossings = 0;

    Axis(double from, double to, int shift) : first(floor_of(from)) {
      const std::int32_t last = floor_of(to);
      if (first == last) return;
      step = last > first ? PackedCell{1} << shift : -(PackedCell{1} << shift);
      crossings = std::abs(last - first);
      constexpr double end = static_cast<double>(kEnd);
      const double length = std::abs(to - from),
                   to_border = last > first ? (first + 1.0) - from : from - first;
      period = static_cast<std::int64_t>(std::min(end / length, end));
      time = static_cast<std::int64_t>(std::min(to_border * (end / length), end));
      time = std::clamp(time, kEnd + 1 - crossings * period, kEnd - (crossings - 1) * period);
    }
    /// Increment of the cell. `mask` is all ones to cross the border, zero to stay.
    PackedCell cross(std::int64_t mask) {
      time += period & mask;
      return step & static_cast<PackedCell>(mask);
    }
    static std::int32_t floor_of(double v) { return static_cast<std::int32_t>(std::floor(v)); }
  };
  Axis x_, y_, z_;
  PackedCell cell_;
};

/// Calls visit(PackedCell) for each cell from that of `from` to that of `to`, until it returns false.
template <class Visit>
void walk_cells(const Vec3& from, const Vec3& to, Visit&& visit) {
  CellWalk walk(from, to);
  for (std::int32_t left = walk.steps(); visit(walk.cell()) && left > 0; --left) walk.advance();
}

}  // namespace karst::core
