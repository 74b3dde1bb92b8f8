#include "sdk/evaluation/reachable/triangle_cells.h"

#include <algorithm>
#include <cmath>

#include "plugins/simulator/cave/closest_point.h"

namespace karst::evaluation {
namespace {

using core::Vec3;

/// Tolerance for faces on a cell border despite rounding: anything nearer than this touches.
constexpr double kRounding_m = 1e-9;

struct KeyBox {
  CellKey low, high;
};

/// Cells that share a point with a closed box; a face on a cell's border belongs to the cells of both sides.
KeyBox cells_touching(const Vec3& low, const Vec3& high, double edge_m) {
  const auto down = [&](double v) {
    return static_cast<std::int32_t>(std::ceil((v - kRounding_m) / edge_m)) - 1;
  };
  const auto up = [&](double v) { return static_cast<std::int32_t>(std::floor((v + kRounding_m) / edge_m)); };
  return {{down(low.x()), down(low.y()), down(low.z())}, {up(high.x()), up(high.y()), up(high.z())}};
}

Vec3 low_of(const Triangle& t) { return t.a.cwiseMin(t.b).cwiseMin(t.c); }
Vec3 high_of(const Triangle& t) { return t.a.cwiseMax(t.b).cwiseMax(t.c); }

template <class Visit>
void for_each_key(const KeyBox& box, const Visit& visit) {
  for (std::int32_t z = box.low.z; z <= box.high.z; ++z)
    for (std::int32_t y = box.low.y; y <= box.high.y; ++y)
      for (std::int32_t x = box.low.x; x <= box.high.x; ++x) visit(CellKey{x, y, z});
}

/// The part of a box of cells that lies in one block, in world cell coordinates.
KeyBox within_block(const KeyBox& box, const CellKey& corner) {
  return {{std::max(box.low.x, corner.x), std::max(box.low.y, corner.y), std::max(box.low.z, corner.z)},
          {std::min(box.high.x, corner.x + 7), std::min(box.high.y, corner.y + 7),
           std::min(box.high.z, corner.z + 7)}};
}

std::uint64_t slice_mask(const KeyBox& part, const CellKey& corner) {
  std::uint64_t mask = 0;
  const std::uint64_t row = (0xffull >> (7 - (part.high.x - part.low.x))) << (part.low.x - corner.x);
  for (std::int32_t y = part.low.y; y <= part.high.y; ++y) mask |= row << (8 * (y - corner.y));
  return mask;
}

}  // namespace

bool overlaps_box(const Triangle& t, const Vec3& center, const Vec3& half) {
  const Vec3 a = t.a - center, b = t.b - center, c = t.c - center;
  for (int i = 0; i < 3; ++i)
    if (std::min({a[i], b[i], c[i]}) > half[i] || std::max({a[i], b[i], c[i]}) < -half[i]) return false;
  const Vec3 ab = b - a, bc = c - b, ca = a - c;
  const Vec3 normal = ab.cross(bc);
  if (std::abs(normal.dot(a)) > half.dot(normal.cwiseAbs())) return false;
  for (const Vec3& edge : {ab, bc, ca})
    for (int i = 0; i < 3; ++i) {
      const Vec3 axis = Vec3::Unit(i).cross(edge);
      const double pa = axis.dot(a), pb = axis.dot(b), pc = axis.dot(c);
      const double radius = half.dot(axis.cwiseAbs());
      if (std::min({pa, pb, pc}) > radius || std::max({pa, pb, pc}) < -radius) return false;
    }
  return true;
}

void insert_touched(CellSet& cells, const Triangle& t, double resolution_m) {
  const KeyBox box = cells_touching(low_of(t), high_of(t), resolution_m);
  const double block_m = CellSet::kEdge * resolution_m;
  const Vec3 half_cell = Vec3::Constant(0.5 * resolution_m + kRounding_m),
             half_block = Vec3::Constant(0.5 * block_m + kRounding_m);
  const KeyBox places{cells.block_of(box.low), cells.block_of(box.high)};
  const bool one_block = places.low == places.high;
  for_each_key(places, [&](const CellKey& place) {
    const CellKey corner = cells.first_cell(place);
    const Vec3 block_center = Vec3(corner.x + 4, corner.y + 4, corner.z + 4) * resolution_m;
    if (!one_block && !overlaps_box(t, block_center, half_block)) return;
    for_each_key(within_block(box, corner), [&](const CellKey& k) {
      if (overlaps_box(t, center_of(k, resolution_m), half_cell)) cells.insert(k);
    });
  });
}

void remove_near(CellSet& cells, const Triangle& t, double resolution_m, double distance_m) {
  // Near a surface already visited few cells remain, and most of those are decided by the centroid, which
  // lies on the triangle, or by the bounding ball: the exact distance is seldom needed.
  const Vec3 centroid = (t.a + t.b + t.c) / 3;
  const double reach =
      distance_m + std::sqrt(std::max({(t.a - centroid).squaredNorm(), (t.b - centroid).squaredNorm(),
                                       (t.c - centroid).squaredNorm()}));
  const Vec3 normal = (t.b - t.a).cross(t.c - t.a).normalized();  // zero for a triangle without area
  const double near_squared = distance_m * distance_m, reach_squared = reach * reach;
  const double block_radius = 4 * resolution_m * std::sqrt(3.0);
  const Vec3 margin = Vec3::Constant(distance_m);
  const KeyBox box = cells_touching(low_of(t) - margin, high_of(t) + margin, resolution_m);
  for_each_key({cells.block_of(box.low), cells.block_of(box.high)}, [&](const CellKey& place) {
    CellSet::Block* block = cells.find(place);
    if (!block) return;
    const CellKey corner = cells.first_cell(place);
    const Vec3 block_center = Vec3(corner.x + 4, corner.y + 4, corner.z + 4) * resolution_m;
    if (std::abs(normal.dot(block_center - t.a)) > distance_m + block_radius) return;
    const KeyBox part = within_block(box, corner);
    const std::uint64_t mask = slice_mask(part, corner);
    for (std::int32_t z = part.low.z; z <= part.high.z; ++z) {
      std::uint64_t& slice = (*block)[static_cast<std::size_t>(z - corner.z)];
      for (std::uint64_t left = slice & mask; left; left &= left - 1) {
        const int bit = std::countr_zero(left);
        const Vec3 p = center_of({corner.x + (bit & 7), corner.y + (bit >> 3), z}, resolution_m);
        const double to_centroid = (p - centroid).squaredNorm();
        if (to_centroid >= near_squared) {
          if (to_centroid > reach_squared || std::abs(normal.dot(p - t.a)) >= distance_m) continue;
          if ((cave::closest_on_triangle(p, t.a, t.b, t.c) - p).squaredNorm() >= near_squared) continue;
        }
        slice &= ~(std::uint64_t{1} << bit);
      }
    }
  });
}

}  // namespace karst::evaluation
