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
  void cover(double a, double b) {
    low = std::min(low, a);
    high = std::max(high, b);
  }
};

/// Rows near one segment; common terms of all rows are computed once.
class RowsNearSegment {
 public:
  RowsNearSegment(const Vec3& a, const Vec3& b, double r)
      : a_(a), b_(b), d_(b - a), l2_(d_.squaredNorm()), r2_(r * r), A_(1 - d_.x() * d_.x() / l2_) {}

  /// x of the points (x, y, z) within r of the segment.
  Interval at(double y, double z) const {
    Interval out;
    const double wy = y - a_.y(), wz = z - a_.z(), vy = y - b_.y(), vz = z - b_.z();
    cover_ball(a_.x(), r2_ - wy * wy - wz * wz, out);
    if (l2_ == 0) return out;  // a point
    cover_ball(b_.x(), r2_ - vy * vy - vz * vz, out);
    if (l2_ < 1e-12) return out;
    // Between the ends: w = (X, wy, wz) from a, t = w.d in [0, |d|^2], |w|^2 - t^2 / |d|^2 <= r^2.
    const double k = wy * d_.y() + wz * d_.z();
    const double half_b = -d_.x() * k / l2_, C = wy * wy + wz * wz - k * k / l2_ - r2_;
    Interval across;  // where the distance to the line is at most r
    if (A_ > 1e-12) {
      const double disc = half_b * half_b - A_ * C;
      if (disc < 0) return out;
      const double root = std::sqrt(disc);
      across.cover((-half_b - root) / A_, (-half_b + root) / A_);
    } else if (C <= 0) {
      across.cover(-1e9, 1e9);
    }
    Interval along;  // where 0 <= t <= |d|^2
    if (std::abs(d_.x()) > 1e-9) {
      along.cover(-k / d_.x(), -k / d_.x());
      along.cover((l2_ - k) / d_.x(), (l2_ - k) / d_.x());
    } else if (k >= 0 && k <= l2_) {
      along.cover(-1e9, 1e9);
    }
    const double low = std::max(along.low, across.low), high = std::min(along.high, across.high);
    if (low <= high) out.cover(a_.x() + low, a_.x() + high);
    return out;
  }

 private:
  static void cover_ball(double x, double h2, Interval& out) {
    if (h2 < 0) return;
    const double h = std::sqrt(h2);
    out.cover(x - h, x + h);
  }

  Vec3 a_, b_, d_;
  double l2_, r2_, A_;
};

/// Calls visit(x_low, x_high, y, z) for each row with cells nearer than r to the segment, until it returns
/// false; returns whether all did. A centre at r, up to rounding, is not nearer than r.
template <class Visit>
bool all_rows_near_segment(const Vec3& a, const Vec3& b, double r, Visit&& visit) {
  constexpr double max_cells = 8;  // long segments go in pieces, or most rows of their box would be empty
  const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / max_cells)));
  r -= 1e-7;
  if (r < 0) return true;
  for (int i = 0; i < pieces; ++i) {
    const Vec3 p = a + (b - a) * i / pieces, q = a + (b - a) * (i + 1) / pieces;
    const RowsNearSegment rows(p, q, r);
    const Vec3 low = p.cwiseMin(q).array() - r, high = p.cwiseMax(q).array() + r;
    for (auto z = static_cast<std::int32_t>(std::ceil(low.z())); z <= high.z(); ++z)
      for (auto y = static_cast<std::int32_t>(std::ceil(low.y())); y <= high.y(); ++y) {
        const Interval row = rows.at(y, z);
        if (row.low > row.high) continue;
        const auto x_low = static_cast<std::int32_t>(std::ceil(row.low));
        const auto x_high = static_cast<std::int32_t>(std::floor(row.high));
        if (x_low <= x_high && !visit(x_low, x_high, y, z)) return false;
      }
  }
  return true;
}

}  // namespace karst::core
