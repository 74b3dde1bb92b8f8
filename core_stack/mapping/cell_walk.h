// The cells a segment passes, face to face (Amanatides and Woo, A Fast Voxel Traversal Algorithm, 1987).
//
// The number of steps along each axis is fixed beforehand from the two ends' cells, so the walk always ends
// in the end's cell, whatever is lost to rounding on the way.
#pragma once
#include <cmath>
#include <cstdlib>
#include <limits>

#include "core_stack/mapping/voxel_map.h"

namespace karst::core {

/// One axis of the walk. `t` is the fraction of the segment at which the next cell border is crossed.
struct WalkAxis {
  std::int32_t step = 0, left = 0;
  double t = std::numeric_limits<double>::infinity(), dt = 0;

  /// `from` and `to` in cells; their cells are a and b.
  WalkAxis(double from, double to, std::int32_t a, std::int32_t b) {
    if (a == b) return;
    step = b > a ? 1 : -1;
    left = std::abs(b - a);
    dt = 1.0 / std::abs(to - from);
    t = (b > a ? (a + 1.0) - from : from - a) * dt;
  }
  void advance() { t = --left > 0 ? t + dt : std::numeric_limits<double>::infinity(); }
};

/// Calls visit(key) for each cell from from's to to's, both included, until it returns false. The segment is
/// given in cells (metres divided by the resolution), within +-1e9.
template <class Visit>
void walk_cells(const Vec3& from, const Vec3& to, Visit&& visit) {
  const auto cell = [](double v) { return static_cast<std::int32_t>(std::floor(v)); };
  CellKey k{cell(from.x()), cell(from.y()), cell(from.z())};
  WalkAxis x(from.x(), to.x(), k.x, cell(to.x()));
  WalkAxis y(from.y(), to.y(), k.y, cell(to.y()));
  WalkAxis z(from.z(), to.z(), k.z, cell(to.z()));
  if (!visit(k)) return;
  while (x.left + y.left + z.left > 0) {
    if (x.t <= y.t && x.t <= z.t) {
      k.x += x.step, x.advance();
    } else if (y.t <= z.t) {
      k.y += y.step, y.advance();
    } else {
      k.z += z.step, z.advance();
    }
    if (!visit(k)) return;
  }
}

}  // namespace karst::core
