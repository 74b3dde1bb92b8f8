#include "sdk/host/services/snapshot.h"

#include <algorithm>
#include <cmath>

#include "core_stack/mapping/occupancy/voxel_reader.h"

namespace karst::host {
namespace {

using core::Cell;
using core::CellKey;

/// The range of keys of the cells whose centres lie in a box. Integers stored as doubles, since a box may
/// extend far beyond any key.
struct KeyBox {
  Eigen::Array3d low, high;

  KeyBox(const karst_box_t& box, double resolution_m)
      : low((to_core(box.low).array() / resolution_m - 0.5).ceil()),
        high((to_core(box.high).array() / resolution_m - 0.5).floor()) {}

  bool empty() const { return (low > high).any(); }
  bool too_large() const { return !((high - low + 1).prod() < 0x1p63); }
  std::uint64_t cells() const { return (high - low + 1).cast<std::uint64_t>().prod(); }
  CellKey low_key() const { return key(low); }
  CellKey high_key() const { return key(high); }

 private:
  /// Clamped to values that are still far outside of the world.
  static CellKey key(const Eigen::Array3d& v) {
    const Eigen::Array3i k = v.max(-1e9).min(1e9).cast<int>();
    return {k.x(), k.y(), k.z()};
  }
};

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
  s->start = original.start;
  s->passages = original.passages;
  return s;
}

karst_map_info_t info_of(const Snapshot& s) {
  return {s.map->resolution_m(), s.revision, s.map->free_cells(), s.map->occupied_cells()};
}

karst_ray_end_t cast_ray(const core::VoxelMap& map, const karst_segment_t& ray, bool through_unknown) {
  const core::Vec3 from = to_core(ray.from), to = to_core(ray.to);
  CellKey end = map.key_of(from);
  // The result if traverse() visits no cell: it does not start far outside the world, where all is unknown.
  Cell stopped_by = through_unknown ? Cell::free : Cell::unknown;
  core::VoxelReader reader(map);
  core::traverse(from, to, map.resolution_m(), [&](const CellKey& k) {
    end = k;
    const Cell c = reader.at(k);
    stopped_by = c == Cell::unknown && through_unknown ? Cell::free : c;
    return stopped_by == Cell::free;
  });
  const core::Vec3 center = map.center_of(end);
  karst_ray_end_t out{};
  out.center = to_abi(center);
  out.length_m = (center - from).norm();
  out.state = static_cast<karst_cell_t>(stopped_by);
  return out;
}

std::optional<karst_cell_counts_t> count_in_box(const core::VoxelMap& map, const karst_box_t& box) {
  karst_cell_counts_t out{};
  const KeyBox keys(box, map.resolution_m());
  if (keys.empty()) return out;
  if (keys.too_large()) return std::nullopt;
  map.for_each_in_box(keys.low_key(), keys.high_key(), [&](const CellKey&, Cell c) {
    if (c == Cell::free) ++out.free;
    if (c == Cell::occupied) ++out.occupied;
  });
  out.unknown = keys.cells() - out.free - out.occupied;
  return out;
}

std::vector<karst_vec3_t> surface_in_box(const core::VoxelMap& map, const karst_box_t& box) {
  const KeyBox keys(box, map.resolution_m());
  if (keys.empty()) return {};
  // One reader per direction: between neighbouring cells it stays in its block.
  std::vector<core::VoxelReader> readers(core::kFaces.size(), core::VoxelReader(map));
  // Cells as numbers in the order z, y, x: sorting them takes a third of the time that sorting keys takes.
  const auto part = [](std::int32_t v) { return static_cast<std::uint64_t>(v + core::kWorldCells); };
  std::vector<std::uint64_t> surface;
  map.for_each_in_box(keys.low_key(), keys.high_key(), [&](const CellKey& k, Cell c) {
    if (c != Cell::occupied) return;
    for (std::size_t face = 0; face < readers.size(); ++face)
      if (readers[face].at(k + core::kFaces[face]) == Cell::free) {
        surface.push_back(part(k.z) << 32 | part(k.y) << 16 | part(k.x));
        return;
      }
  });
  std::sort(surface.begin(), surface.end());
  std::vector<karst_vec3_t> out;
  out.reserve(surface.size());
  for (const std::uint64_t cell : surface) {
    const auto coordinate = [cell](int shift) {
      return static_cast<std::int32_t>(cell >> shift & 0xffff) - core::kWorldCells;
    };
    out.push_back(to_abi(map.center_of({coordinate(0), coordinate(16), coordinate(32)})));
  }
  return out;
}

std::optional<double> distance_to_rock(const core::VoxelMap& map, const core::Vec3& p, double limit_m,
                                       core::WorkBudget& work) {
  const double resolution_m = map.resolution_m();
  const CellKey own = map.key_of(p);
  const auto most = static_cast<std::int32_t>(std::ceil(limit_m / resolution_m));
  double best_m = limit_m;
  const auto look = [&](const CellKey& d) {
    const CellKey k = own + d;
    if (map.at(k) == Cell::occupied) best_m = std::min(best_m, (map.center_of(k) - p).norm());
  };
  // Cubes of cells around p's own, from the inside out. A centre on cube r is at least r - 1/2 cells away.
  for (std::int32_t r = 0; r <= most && best_m > (r - 0.5) * resolution_m; ++r) {
    const auto edge = static_cast<std::uint64_t>(2 * r + 1);
    if (!work.spend(r == 0 ? 1 : 6 * edge * edge)) return std::nullopt;
    for (std::int32_t z = -r; z <= r; ++z)
      for (std::int32_t y = -r; y <= r; ++y) {
        const bool on_face = z == -r || z == r || y == -r || y == r;
        for (std::int32_t x = -r; x <= r; x += on_face ? 1 : 2 * r) look({x, y, z});
      }
  }
  return best_m;
}

}  // namespace karst::host
