// Traverses the cells of a segment face by face (Amanatides and Woo, A Fast Voxel Traversal Algorithm, 1987).
//
// Which axis is crossed next cannot be predicted, so the step has no branch: times are integers, and what a
// step adds is read from a table. One unit of time is 2^-60 of the segment. An axis crosses its last border
// no later than kEnd and would cross the next one after kEnd. This holds exactly, so the walk always ends in
// the end's cell despite rounding.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "core_stack/mapping/occupancy/packed_cell.h"

namespace karst::core {

class CellWalk {
 public:
  /// What is added to a number that stands for a cell, to get that of the next one along each axis.
  struct Strides {
    std::uint64_t x, y, z;
  };

  /// The segment in units of cells (metres divided by the resolution), within +-kPackedLimit.
  CellWalk(const Vec3& from, const Vec3& to)
      : CellWalk(from, to, {PackedCell{1} << kShiftX, PackedCell{1} << kShiftY, 1}) {
    cell_ += pack({floor_of(from.x()), floor_of(from.y()), floor_of(from.z())});
  }
  /// The same, with cells numbered otherwise. The first cell's number is 0: cell() counts from it.
  CellWalk(const Vec3& from, const Vec3& to, const Strides& strides) {
    const Axis x(from.x(), to.x()), y(from.y(), to.y()), z(from.z(), to.z());
    steps_ = x.crossings + y.crossings + z.crossings;
    x_before_y_ = x.time - y.time;
    x_before_z_ = x.time - z.time;
    const auto signed_stride = [](const Axis& axis, std::uint64_t stride) {
      return axis.forward ? stride : -stride;
    };
    next_[0] = {0, -z.period, signed_stride(z, strides.z)};
    next_[1] = {-y.period, 0, signed_stride(y, strides.y)};
    next_[2] = next_[3] = {x.period, x.period, signed_stride(x, strides.x)};
  }

  std::uint64_t cell() const { return cell_; }
  /// Number of steps from the first cell to the last.
  std::int32_t steps() const { return steps_; }
  /// Must be called at most steps() times. Of borders that are crossed at once, z comes first and x last.
  void advance() {
    const bool y_before_z = x_before_z_ - x_before_y_ < 0, x_first = (x_before_y_ & x_before_z_) < 0;
    const Step& step = next_[std::size_t{x_first} << 1 | std::size_t{y_before_z}];
    x_before_y_ += step.x_before_y;
    x_before_z_ += step.x_before_z;
    cell_ += step.cell;
  }

 private:
  static std::int32_t floor_of(double v) { return static_cast<std::int32_t>(std::floor(v)); }

  struct Axis {
    static constexpr std::int64_t kEnd = std::int64_t{1} << 60;
    std::int64_t time = 2 * kEnd, period = 0;  // of the next crossing; time between crossings
    std::int32_t crossings = 0;
    bool forward = true;

    Axis(double from, double to) {
      const std::int32_t first = floor_of(from), last = floor_of(to);
      if (first == last) return;
      forward = last > first;
      crossings = std::abs(last - first);
      constexpr double end = static_cast<double>(kEnd);
      const double length = std::abs(to - from), to_border = forward ? (first + 1.0) - from : from - first;
      period = static_cast<std::int64_t>(std::min(end / length, end));
      time = static_cast<std::int64_t>(std::min(to_border * (end / length), end));
      time = std::clamp(time, kEnd + 1 - crossings * period, kEnd - (crossings - 1) * period);
    }
  };
  /// What crossing a border adds.
  struct Step {
    std::int64_t x_before_y, x_before_z;
    std::uint64_t cell;
  };
  // Differences of the times of the next crossings, which stay below 2^62: they do not overflow.
  std::int64_t x_before_y_, x_before_z_;
  std::uint64_t cell_ = 0;
  std::int32_t steps_;
  std::array<Step, 4> next_;  // z, y, x, x
};

/// Calls visit(PackedCell) for each cell from that of `from` to that of `to`, until it returns false.
template <class Visit>
void walk_cells(const Vec3& from, const Vec3& to, Visit&& visit) {
  CellWalk walk(from, to);
  for (std::int32_t left = walk.steps(); visit(walk.cell()) && left > 0; --left) walk.advance();
}

}  // namespace karst::core
