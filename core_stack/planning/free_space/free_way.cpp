#include "core_stack/planning/free_space/free_way.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "core_stack/mapping/occupancy/voxel_reader.h"

namespace karst::core {

bool sees(const VoxelMap& map, const Vec3& from, const Vec3& to) { return !map.first_not_free(from, to); }

std::optional<Vec3> free_near(const VoxelMap& map, const Vec3& p) {
  constexpr std::int32_t kAround = 3;
  const CellKey own = map.key_of(p);
  if (map.at(own) == Cell::free) return p;
  std::optional<Vec3> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::int32_t z = -kAround; z <= kAround; ++z)
    for (std::int32_t y = -kAround; y <= kAround; ++y)
      for (std::int32_t x = -kAround; x <= kAround; ++x) {
        const CellKey k = own + CellKey{x, y, z};
        if (map.at(k) != Cell::free) continue;
        const Vec3 center = map.center_of(k);
        if (const double away = (center - p).squaredNorm(); away < least) {
          least = away;
          nearest = center;
        }
      }
  return nearest;
}

std::optional<std::vector<Vec3>> free_way(const VoxelMap& map, const Vec3& from, const Vec3& to,
                                          double margin_m, std::size_t most_cells) {
  const CellKey first = map.key_of(from), last = map.key_of(to);
  const auto margin = static_cast<std::int32_t>(std::ceil(margin_m / map.resolution_m()));
  const CellKey low{std::min(first.x, last.x) - margin, std::min(first.y, last.y) - margin,
                    std::min(first.z, last.z) - margin};
  const CellKey high{std::max(first.x, last.x) + margin, std::max(first.y, last.y) + margin,
                     std::max(first.z, last.z) + margin};
  const auto inside = [&](const CellKey& k) {
    return k.x >= low.x && k.y >= low.y && k.z >= low.z && k.x <= high.x && k.y <= high.y && k.z <= high.z;
  };
  VoxelReader reader(map);
  std::unordered_map<CellKey, CellKey, CellKeyHash> before{{last, last}};
  std::vector<CellKey> open{last};  // backwards, so that the way is read off forwards
  for (std::size_t at = 0; at < open.size() && open.size() < most_cells && !before.contains(first); ++at) {
    const CellKey here = open[at];
    for (const CellKey& face : kFaces) {
      const CellKey there = here + face;
      if (!inside(there) || before.contains(there) || reader.at(there) != Cell::free) continue;
      before.emplace(there, here);
      open.push_back(there);
    }
  }
  if (!before.contains(first)) return std::nullopt;
  std::vector<Vec3> way;
  // The centres of the ends' own cells too: from them, and only from them, the next cell is surely in sight.
  for (CellKey k = first; k != last; k = before.at(k)) way.push_back(map.center_of(k));
  way.push_back(map.center_of(last));
  return way;
}

}  // namespace karst::core
