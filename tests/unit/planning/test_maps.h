// Maps drawn by hand or at random, for the planning tests and benchmarks.
#pragma once
#include <cmath>
#include <functional>
#include <vector>

#include "core_stack/common/random.h"
#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/planning/path/path.h"

namespace karst::core {

/// Of the planning tests' vehicle.
inline const PlanningOptions kOptions{.clearance_m = 0.45};

}  // namespace karst::core

namespace karst::core::testing {

/// What cell k is.
using CellRule = std::function<Cell(const CellKey&)>;

/// Sets every cell of the closed box as `rule` says by casting rays of one cell's length; the changes are
/// appended to `changes`.
inline void draw(VoxelMap& map, const CellKey& low, const CellKey& high, const CellRule& rule,
                 std::vector<CellChange>* changes = nullptr) {
  std::vector<Ray> free, occupied;
  const Vec3f one_cell(static_cast<float>(map.resolution_m()), 0, 0);
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) {
        const Cell c = rule({x, y, z});
        const Vec3f p = map.center_of({x, y, z}).cast<float>();
        if (c == Cell::free) free.push_back({p, p + one_cell, false});  // the end's cell stays as it is
        if (c == Cell::occupied) occupied.push_back({p, p, true});
      }
  for (const auto* rays : {&free, &occupied}) {
    const std::vector<CellChange> c = map.insert(*rays);
    if (changes != nullptr) changes->insert(changes->end(), c.begin(), c.end());
  }
}

/// Free inside the box except for random obstacle cells with the given share, a third of them unknown.
inline VoxelMap random_map(std::uint64_t seed, const CellKey& size, double fraction,
                           std::vector<CellChange>* changes = nullptr) {
  VoxelMap map{MapOptions{}};
  Random random(seed);
  draw(
      map, {0, 0, 0}, {size.x - 1, size.y - 1, size.z - 1},
      [&](const CellKey&) {
        if (random.uniform() >= fraction) return Cell::free;
        return random.uniform() < 0.33 ? Cell::unknown : Cell::occupied;
      },
      changes);
  return map;
}

/// All known cells as if they had just changed: what a roadmap built from scratch is given.
inline std::vector<CellChange> all_cells(const VoxelMap& map) {
  std::vector<CellChange> out;
  map.for_each_known([&out](const CellKey& k, Cell c, float) { out.push_back({k, Cell::unknown, c}); });
  return out;
}

/// Smooth noise in [-1, 1]: random values on a lattice of `period` metres, interpolated.
inline double noise(const Vec3& p, double period, std::uint64_t seed) {
  const Vec3 q = p / period, base = q.array().floor(), t = q - base;
  const Vec3 s = t.array() * t.array() * (3.0 - 2.0 * t.array());
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    std::uint64_t h = seed;
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const int bit = i >> axis & 1;
      h = (h ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(base[axis]) + bit)) *
          0x9e3779b97f4a7c15ull;
      h ^= h >> 29;
      weight *= bit ? s[axis] : 1 - s[axis];
    }
    sum += weight * (2.0 * Random(h).uniform() - 1.0);
  }
  return sum;
}

/// A winding tunnel with rough walls and side chambers: a centre line and a radius that varies along it.
struct WindingCave {
  std::vector<Vec3> line;  // every half metre
  double radius_m = 2.0, roughness_m = 0.7;
  std::uint64_t seed = 1;

  static WindingCave of_length(double length_m, std::uint64_t seed, double radius_m = 2.0) {
    WindingCave cave;
    cave.seed = seed;
    cave.radius_m = radius_m;
    Vec3 p = Vec3::Zero();
    for (double s = 0; s <= length_m; s += 0.5) {
      cave.line.push_back(p);
      const double turn = 1.1 * noise({s, 0, 0}, 14.0, seed + 1),
                   climb = 0.35 * noise({s, 9, 0}, 18.0, seed + 2);
      p += 0.5 * Vec3(std::cos(turn) * std::cos(climb), std::sin(turn) * std::cos(climb), std::sin(climb));
    }
    return cave;
  }

  /// The map of the cave: cells inside are free, a shell of two cells around them occupied.
  VoxelMap map(std::vector<CellChange>* changes = nullptr) const {
    VoxelMap out{MapOptions{}};
    std::vector<Ray> free, rock;
    const Vec3f one_cell(static_cast<float>(out.resolution_m()), 0, 0);
    // Distance to the rock, negative inside the cave, sampled where the line passes.
    const auto outside = [&](const Vec3& p, std::size_t from, std::size_t to) {
      double d = 1e9;
      for (std::size_t i = from; i < to; ++i) {
        const bool chamber = i % 34 == 20;
        d = std::min(d, (p - line[i]).norm() - (chamber ? 2.2 * radius_m : radius_m));
      }
      return d + roughness_m * noise(p, 1.5, seed + 3);
    };
    const double reach = 2.2 * radius_m + roughness_m + 0.8;
    constexpr std::size_t piece = 8;
    for (std::size_t i = 0; i < line.size(); i += piece) {
      const std::size_t end = std::min(line.size(), i + piece);
      Vec3 low = line[i], high = line[i];
      for (std::size_t k = i; k < end; ++k) low = low.cwiseMin(line[k]), high = high.cwiseMax(line[k]);
      const CellKey a = out.key_of(low - Vec3::Constant(reach)), b = out.key_of(high + Vec3::Constant(reach));
      const std::size_t margin = 24;
      const std::size_t from = i > margin ? i - margin : 0, to = std::min(line.size(), end + margin);
      for (int z = a.z; z <= b.z; ++z)
        for (int y = a.y; y <= b.y; ++y)
          for (int x = a.x; x <= b.x; ++x) {
            if (out.at(CellKey{x, y, z}) != Cell::unknown) continue;
            const Vec3 p = out.center_of({x, y, z});
            const double d = outside(p, from, to);
            if (d < 0)
              free.push_back({p.cast<float>(), p.cast<float>() + one_cell, false});
            else if (d < 0.4)
              rock.push_back({p.cast<float>(), p.cast<float>(), true});
          }
      for (auto* rays : {&free, &rock}) {
        const std::vector<CellChange> c = out.insert(*rays);
        if (changes != nullptr) changes->insert(changes->end(), c.begin(), c.end());
        rays->clear();
      }
    }
    return out;
  }
};

}  // namespace karst::core::testing
