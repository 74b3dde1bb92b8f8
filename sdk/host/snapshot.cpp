#include "sdk/host/snapshot.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace karst::host {
namespace {

using core::Cell;
using core::CellKey;

struct KeyBox {
  CellKey low, high;
  bool empty() const { return low.x > high.x || low.y > high.y || low.z > high.z; }
  double cells() const { return (high.x - low.x + 1.0) * (high.y - low.y + 1.0) * (high.z - low.z + 1.0); }
};

/// Keys of the cells whose centres lie in the box.
KeyBox keys_in(const karst_box_t& box, double resolution_m) {
  const auto bound = [](double v) { return static_cast<std::int32_t>(std::clamp(v, -1e9, 1e9)); };
  const auto low = [&](double v) { return bound(std::ceil(v / resolution_m - 0.5)); };
  const auto high = [&](double v) { return bound(std::floor(v / resolution_m - 0.5)); };
  return {{low(box.low.x), low(box.low.y), low(box.low.z)},
          {high(box.high.x), high(box.high.y), high(box.high.z)}};
}

}  // namespace

std::unique_ptr<Snapshot> copy_of(const Snapshot& original) {
  core::MapOptions options;
  options.resolution_m = original.map->resolution_m();
  auto copy = std::make_unique<core::VoxelMap>(options);
  original.map->for_each_known([&](const CellKey& k, Cell, float log_odds) { copy->assign(k, 1, log_odds); });
  auto s = std::make_unique<Snapshot>();
  s->map = copy.get();
  s->revision = original.revision;
  s->copy = std::move(copy);
  return s;
}

karst_map_info_t info_of(const Snapshot& s) {
  return {s.map->resolution_m(), s.revision, s.map->free_cells(), s.map->occupied_cells()};
}

karst_ray_end_t cast_ray(const core::VoxelMap& map, const karst_segment_t& ray, bool through_unknown) {
  const core::Vec3 from = to_core(ray.from), to = to_core(ray.to);
  CellKey end = map.key_of(from);
  Cell stopped_by = Cell::free;
  core::traverse(from, to, map.resolution_m(), [&](const CellKey& k) {
    end = k;
    const Cell c = map.at(k);
    if (c == Cell::occupied || (c == Cell::unknown && !through_unknown)) stopped_by = c;
    return stopped_by == Cell::free;
  });
  const core::Vec3 center = map.center_of(end);
  karst_ray_end_t out{};
  out.center = to_abi(center);
  out.length_m = (center - from).norm();
  out.state = static_cast<karst_cell_t>(stopped_by);
  return out;
}

karst_cell_counts_t count_in_box(const core::VoxelMap& map, const karst_box_t& box) {
  karst_cell_counts_t out{};
  const KeyBox keys = keys_in(box, map.resolution_m());
  if (keys.empty()) return out;
  map.for_each_in_box(keys.low, keys.high, [&](const CellKey&, Cell c) {
    if (c == Cell::free) ++out.free;
    if (c == Cell::occupied) ++out.occupied;
  });
  out.unknown = static_cast<std::uint64_t>(keys.cells()) - out.free - out.occupied;
  return out;
}

std::vector<karst_vec3_t> surface_in_box(const core::VoxelMap& map, const karst_box_t& box) {
  std::vector<CellKey> surface;
  const KeyBox keys = keys_in(box, map.resolution_m());
  if (keys.empty()) return {};
  constexpr CellKey faces[] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
  map.for_each_in_box(keys.low, keys.high, [&](const CellKey& k, Cell c) {
    const auto is_free = [&](const CellKey& face) { return map.at(k + face) == Cell::free; };
    if (c == Cell::occupied && std::any_of(std::begin(faces), std::end(faces), is_free)) surface.push_back(k);
  });
  std::sort(surface.begin(), surface.end(), [](const CellKey& a, const CellKey& b) {
    return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
  });
  std::vector<karst_vec3_t> out;
  out.reserve(surface.size());
  for (const CellKey& k : surface) out.push_back(to_abi(map.center_of(k)));
  return out;
}

}  // namespace karst::host
