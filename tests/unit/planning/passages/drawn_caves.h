// Caves by formula: how far inside the free space a point is, negative in the rock.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "core_stack/planning/passages/free_parts.h"

namespace karst::core::testing {

using Depth = std::function<double(const Vec3&)>;

/// A round tube about a polyline, with ends like half balls.
inline Depth tube(std::vector<Vec3> axis, double radius_m) {
  return [axis = std::move(axis), radius_m](const Vec3& p) {
    double nearest = 1e9;
    for (std::size_t i = 1; i < axis.size(); ++i) {
      const Vec3 d = axis[i] - axis[i - 1];
      const double s = std::clamp((p - axis[i - 1]).dot(d) / d.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (p - axis[i - 1] - s * d).norm());
    }
    return radius_m - nearest;
  };
}
inline Depth box(const Vec3& low, const Vec3& high) {
  return [=](const Vec3& p) { return std::min((p - low).minCoeff(), (high - p).minCoeff()); };
}
inline Depth either(Depth a, Depth b) {
  return [a = std::move(a), b = std::move(b)](const Vec3& p) { return std::max(a(p), b(p)); };
}
inline Depth without(Depth a, Depth rock) {
  return [a = std::move(a), rock = std::move(rock)](const Vec3& p) { return std::min(a(p), -rock(p)); };
}
inline std::vector<Vec3> circle(double radius_m) {
  std::vector<Vec3> axis;
  for (int i = 0; i <= 90; ++i) {
    const double a = 2 * std::numbers::pi * i / 90;
    axis.emplace_back(radius_m * std::cos(a), radius_m * std::sin(a), 0);
  }
  return axis;
}

/// What is known of a cave: all of it, or the part for which `seen` holds.
using Seen = std::function<bool(const Vec3&)>;

/// Its map: free cells, and the rock within 0.45 m of them, or within a cell.
inline VoxelMap map_of(const Depth& depth, const Vec3& low, const Vec3& high, double resolution_m = 0.2,
                       const Seen& seen = {}) {
  VoxelMap map{MapOptions{.resolution_m = resolution_m}};
  const CellKey a = map.key_of(low), b = map.key_of(high);
  for (CellKey k{0, 0, a.z}; k.z <= b.z; ++k.z)
    for (k.y = a.y; k.y <= b.y; ++k.y)
      for (k.x = a.x; k.x <= b.x; ++k.x) {
        const Vec3 p = map.center_of(k);
        const double d = depth(p);
        if (d > -std::max(0.45, resolution_m) && (!seen || seen(p))) map.assign(k, 1, d > 0 ? -2.0f : 2.0f);
      }
  return map;
}

inline FreeParts parts_of(const VoxelMap& map, const Vec3& start) {
  WorkBudget work(kMaxPassageWork);
  return free_parts_around(map, start, work).value();
}

}  // namespace karst::core::testing
