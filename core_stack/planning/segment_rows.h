// The cells whose centres are near a segment, as one interval of x for each row (y, z). Points nearer than r
// to a segment form a convex body, so every row meets it in one interval: no sampling along the segment.
//
// Lengths in cells; cell k's centre is at k (metres / resolution - 1/2).
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core_stack/common/geometry.h"

namespace karst::core {

struct Interval {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void cover(double a, double b) { low = std::min(low, a), high = std::max(high, b); }
};

/// x of the points (x, y, z) within r of the segment from a to b.
inline Interval row_near_segment(const Vec3& a, const Vec3& b, double r, double y, double z) {
  Interval out;
  for (const Vec3& end : {a, b}) {
    const double h2 = r * r - (y - end.y()) * (y - end.y()) - (z - end.z()) * (z - end.z());
    if (h2 >= 0) out.cover(end.x() - std::sqrt(h2), end.x() + std::sqrt(h2));
  }
  // Between the ends: w = (X, wy, wz) from a, t = w.d in [0, |d|^2], |w|^2 - t^2 / |d|^2 <= r^2.
  const Vec3 d = b - a;
  const double l2 = d.squaredNorm();
  if (l2 < 1e-12) return out;
  const double wy = y - a.y(), wz = z - a.z(), k = wy * d.y() + wz * d.z();
  Interval along;  // where 0 <= t <= |d|^2
  if (std::abs(d.x()) > 1e-9) {
    along.cover(-k / d.x(), -k / d.x()), along.cover((l2 - k) / d.x(), (l2 - k) / d.x());
  } else if (k >= 0 && k <= l2) {
    along.cover(-1e9, 1e9);
  }
  const double A = 1 - d.x() * d.x() / l2, half_b = -d.x() * k / l2,
               C = wy * wy + wz * wz - k * k / l2 - r * r;
  Interval across;  // where the distance to the line is at most r
  if (A > 1e-12) {
    const double disc = half_b * half_b - A * C;
    if (disc >= 0) across.cover((-half_b - std::sqrt(disc)) / A, (-half_b + std::sqrt(disc)) / A);
  } else if (C <= 0) {
    across.cover(-1e9, 1e9);
  }
  const double low = std::max(along.low, across.low), high = std::min(along.high, across.high);
  if (low <= high) out.cover(a.x() + low, a.x() + high);
  return out;
}

/// Calls visit(x_low, x_high, y, z) for each row with cells nearer than r to the segment, until it returns
/// false; returns whether all did. A centre at r, up to rounding, is not nearer than r.
template <class Visit>
bool all_rows_near_segment(const Vec3& a, const Vec3& b, double r, Visit&& visit) {
  constexpr double most_cells = 8;  // long segments go in pieces, or most rows of their box would be empty
  const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / most_cells)));
  r -= 1e-7;
  if (r < 0) return true;
  for (int i = 0; i < pieces; ++i) {
    const Vec3 p = a + (b - a) * i / pieces, q = a + (b - a) * (i + 1) / pieces;
    const Vec3 low = p.cwiseMin(q).array() - r, high = p.cwiseMax(q).array() + r;
    for (auto z = static_cast<std::int32_t>(std::ceil(low.z())); z <= high.z(); ++z)
      for (auto y = static_cast<std::int32_t>(std::ceil(low.y())); y <= high.y(); ++y) {
        const Interval row = row_near_segment(p, q, r, y, z);
        if (row.low > row.high) continue;
        const auto x_low = static_cast<std::int32_t>(std::ceil(row.low));
        const auto x_high = static_cast<std::int32_t>(std::floor(row.high));
        if (x_low <= x_high && !visit(x_low, x_high, y, z)) return false;
      }
  }
  return true;
}

}  // namespace karst::core
