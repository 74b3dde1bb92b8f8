#include "sdk/cave_drawing/way_between.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "core_stack/mapping/occupancy/voxel_reader.h"

namespace karst::cave_drawing {
namespace {

using core::CellKey;
using core::Vec3;

constexpr double kAround_m = 3;
constexpr std::size_t kMostSeen = 200'000;

std::vector<Vec3> straight_way(const Vec3& from, const Vec3& to, double step_m) {
  const auto n = std::max(1, static_cast<int>(std::ceil((to - from).norm() / step_m)));
  std::vector<Vec3> way;
  for (int k = 0; k <= n; ++k) way.push_back(from + static_cast<double>(k) / n * (to - from));
  return way;
}

}  // namespace

std::vector<Vec3> way_between(const core::VoxelMap& map, const Vec3& from, const Vec3& to, double step_m) {
  const std::vector<Vec3> straight = straight_way(from, to, step_m);
  const CellKey start = map.key_of(from), goal = map.key_of(to);
  core::VoxelReader reader(map);
  const auto is_free = [&](const CellKey& k) { return reader.at(k) == core::Cell::free; };
  if (std::all_of(straight.begin(), straight.end(), [&](const Vec3& p) { return is_free(map.key_of(p)); }) ||
      !is_free(start) || !is_free(goal))
    return straight;
  const CellKey low = map.key_of(from.cwiseMin(to) - Vec3::Constant(kAround_m));
  const CellKey high = map.key_of(from.cwiseMax(to) + Vec3::Constant(kAround_m));
  std::unordered_map<CellKey, CellKey, core::CellKeyHash> before{{goal, goal}};
  std::vector<CellKey> open{goal};
  for (std::size_t i = 0; i < open.size() && open.size() < kMostSeen && !before.contains(start); ++i)
    for (const CellKey& face : core::kFaces) {
      const CellKey k = open[i] + face;
      if (k.x < low.x || k.y < low.y || k.z < low.z || k.x > high.x || k.y > high.y || k.z > high.z) continue;
      if (!is_free(k) || !before.emplace(k, open[i]).second) continue;
      open.push_back(k);
    }
  if (!before.contains(start)) return straight;
  std::vector<Vec3> way{from};
  for (CellKey k = start; k != goal; k = before.at(k)) way.push_back(map.center_of(k));
  way.push_back(to);
  return way;
}

}  // namespace karst::cave_drawing
