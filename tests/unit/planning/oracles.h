// Slow and simple answers to judge the fast ones by.
#pragma once
#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core::testing {

inline double point_segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double l2 = d.squaredNorm();
  const double t = l2 > 0 ? std::clamp((p - a).dot(d) / l2, 0.0, 1.0) : 0.0;
  return (p - (a + t * d)).norm();
}

/// A map's obstacles as the docs define them: occupied cells, and unknown ones that share a face with a free
/// one.
class Obstacles {
 public:
  explicit Obstacles(const VoxelMap& map) : map_(map) {
    std::set<CellKey> keys;
    map.for_each_known([&](const CellKey& k, Cell c, float) {
      if (c == Cell::occupied) keys.insert(k);
      for (const CellKey d : {CellKey{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}})
        if (c == Cell::free && map.at(k + d) == Cell::unknown) keys.insert(k + d);
    });
    for (const CellKey& k : keys) centers_.push_back(map.center_of(k));
  }

  /// Distance of the segment to the nearest obstacle's centre; -1 if it leaves free cells.
  double distance(const Vec3& a, const Vec3& b) const {
    const int steps = 1 + static_cast<int>((b - a).norm() / 0.01);
    for (int i = 0; i <= steps; ++i)
      if (map_.at(Vec3(a + (b - a) * i / steps)) != Cell::free) return -1;
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& c : centers_) least = std::min(least, point_segment_distance(c, a, b));
    return least;
  }
  double distance(const Vec3& p) const { return distance(p, p); }

 private:
  const VoxelMap& map_;
  std::vector<Vec3> centers_;
};

/// Least length in metres from cell to cell by Dijkstra's algorithm over cells in [0, size) whose centre is
/// `clearance_m` from every obstacle, 26 moves.
inline std::optional<double> dijkstra_m(const VoxelMap& map, const Obstacles& obstacles, const CellKey& size,
                                        const CellKey& from, const CellKey& to, double clearance_m) {
  std::map<CellKey, bool> usable;
  const auto ok = [&](const CellKey& k) {
    if (k.x < 0 || k.y < 0 || k.z < 0 || k.x >= size.x || k.y >= size.y || k.z >= size.z) return false;
    const auto it = usable.find(k);
    if (it != usable.end()) return it->second;
    return usable[k] = obstacles.distance(map.center_of(k)) >= clearance_m - 1e-6;
  };
  if (!ok(from) || !ok(to)) return std::nullopt;
  std::map<CellKey, double> length{{from, 0.0}};
  std::set<std::pair<double, CellKey>> open{{0.0, from}};
  while (!open.empty()) {
    const auto [l, k] = *open.begin();
    open.erase(open.begin());
    if (k == to) return l;
    for (int m = 0; m < 27; ++m) {
      const CellKey n = k + CellKey{m % 3 - 1, m / 3 % 3 - 1, m / 9 - 1};
      if (!ok(n)) continue;
      const double candidate = l + (map.center_of(n) - map.center_of(k)).norm();
      const auto it = length.find(n);
      if (it != length.end() && it->second <= candidate) continue;
      if (it != length.end()) open.erase({it->second, n});
      length[n] = candidate;
      open.insert({candidate, n});
    }
  }
  return std::nullopt;
}

// Polylines.
inline double length_of(const std::vector<Vec3>& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

inline double distance_to_path(const std::vector<Vec3>& path, const Vec3& p) {
  double least = 1e9;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Vec3 d = path[i] - path[i - 1];
    const double l2 = d.squaredNorm(), t = l2 > 0 ? std::clamp((p - path[i - 1]).dot(d) / l2, 0.0, 1.0) : 0;
    least = std::min(least, (p - path[i - 1] - t * d).norm());
  }
  return least;
}

}  // namespace karst::core::testing
