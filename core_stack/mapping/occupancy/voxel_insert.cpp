// Writing to the map: one scan's rays, or a ball declared free.
#include "core_stack/mapping/occupancy/scan_marks.h"
#include "core_stack/mapping/occupancy/voxel_storage.h"

namespace karst::core {
namespace {

/// Rays seen so far, by the cell of their origin and the half cell (an eighth of the volume) of their end.
/// Rays that agree in both pass the same cells except a few in ten thousand. The table grows with its
/// contents, a fraction of all rays, so that it stays in the cache.
class RaySet {
 public:
  /// True if the ray is new. A sweep starts from few cells; beyond kOrigins origin cells, rays always count
  /// as new.
  bool add(const CellKey& origin, const CellKey& end_in_half_cells, bool hit) {
    const std::optional<std::uint64_t> from = number_of(pack(origin));
    if (!from) return true;
    const auto part = [](std::int32_t v) { return static_cast<std::uint64_t>(v + 2 * kWorldCells); };
    const std::uint64_t ray = (*from + 1) << 52 | std::uint64_t{hit} << 51 | part(end_in_half_cells.x) << 34 |
                              part(end_in_half_cells.y) << 17 | part(end_in_half_cells.z);
    if (ray == last_) return false;
    last_ = ray;
    if (!place(ray)) return false;
    if (++count_ * 2 > slots_.size()) grow();
    return true;
  }

 private:
  static constexpr std::size_t kOrigins = 64;

  std::optional<std::size_t> number_of(PackedCell origin) {
    if (current_ < origins_.size() && origins_[current_] == origin) return current_;
    current_ =
        static_cast<std::size_t>(std::find(origins_.begin(), origins_.end(), origin) - origins_.begin());
    if (current_ == kOrigins) return std::nullopt;
    if (current_ == origins_.size()) origins_.push_back(origin);
    return current_;
  }
  bool place(std::uint64_t ray) {
    for (std::size_t i = slot_of(ray, slots_.size());; i = (i + 1) & (slots_.size() - 1)) {
      if (slots_[i] == ray) return false;
      if (slots_[i] == 0) {
        slots_[i] = ray;
        return true;
      }
    }
  }
  void grow() {
    std::vector<std::uint64_t> former(2 * slots_.size());
    former.swap(slots_);
    for (const std::uint64_t ray : former)
      if (ray != 0) place(ray);
  }

  std::vector<PackedCell> origins_;  // the origins numbered so far
  std::size_t current_ = 0, count_ = 0;
  std::uint64_t last_ = 0;
  std::vector<std::uint64_t> slots_ = std::vector<std::uint64_t>(4096);
};

/// Converts `p` to cells; false for NaN.
bool inside(const Vec3& p) {
  const auto in = [](double v) { return v >= -kWorldCells && v < kWorldCells; };
  return in(p.x()) && in(p.y()) && in(p.z());
}
CellKey cell_at(const Vec3& p) {
  const auto floor_of = [](double v) { return static_cast<std::int32_t>(std::floor(v)); };
  return {floor_of(p.x()), floor_of(p.y()), floor_of(p.z())};
}

/// The rays that are to be cast: no two that pass the same cells.
std::vector<Beam> distinct_beams(std::span<const Ray> rays, double cells_per_m) {
  RaySet seen;
  std::vector<Beam> out;
  out.reserve(rays.size());
  for (const Ray& ray : rays) {
    const Vec3 from = ray.origin.cast<double>() * cells_per_m, to = ray.end.cast<double>() * cells_per_m;
    if (!inside(from) || !inside(to)) continue;
    const CellKey first = cell_at(from);
    if (seen.add(first, cell_at(2.0 * to), ray.hit)) out.push_back({from, to, first, cell_at(to), ray.hit});
  }
  return out;
}

/// The number of steps from cell to cell along all beams.
double steps_of(std::span<const Beam> beams) {
  double steps = 0;
  for (const Beam& b : beams)
    steps += std::abs(b.last.x - b.first.x) + std::abs(b.last.y - b.first.y) + std::abs(b.last.z - b.first.z);
  return steps;
}

MarkGrid grid_around(std::span<const Beam> beams, std::vector<Mark>& cells) {
  CellKey low = beams.front().first, high = low;
  for (const Beam& b : beams)
    for (const CellKey& k : {b.first, b.last}) {
      low = {std::min(low.x, k.x), std::min(low.y, k.y), std::min(low.z, k.z)};
      high = {std::max(high.x, k.x), std::max(high.y, k.y), std::max(high.z, k.z)};
    }
  return {low, high, cells};
}

}  // namespace

std::vector<CellChange> VoxelMap::insert(std::span<const Ray> rays) {
  Storage& s = *storage_;
  ++s.revision;
  const std::vector<Beam> beams = distinct_beams(rays, s.cells_per_m);
  std::vector<CellChange> changes;
  if (beams.empty()) return changes;
  BlockId id = ~BlockId{0};
  Block* block = nullptr;
  const auto update = [&](BlockId of, std::uint32_t first, std::uint64_t eight) {
    if (of != id) {
      id = of;
      block = &s.blocks.find_or_add(id);
    }
    for_each_mark(first, eight, [&](std::uint32_t i, bool hit) {
      const std::int16_t v = block->log_odds[i];
      if (v == (hit ? s.high : s.low)) return;  // saturated, like most cells of a place seen before
      const int sum = (v == kUnknown ? 0 : v) + (hit ? s.hit : s.miss);
      s.set(*block, corner_of(id), i, static_cast<std::int16_t>(std::clamp<int>(sum, s.low, s.high)),
            changes);
    });
  };
  // The array's time grows with its box, that of single blocks with the beams: few long beams take blocks.
  constexpr double kMostCells = 1 << 25, kMostCellsAStep = 6;  // 32 MiB
  if (MarkGrid grid = grid_around(beams, s.marks);
      grid.cell_count() <= std::min(kMostCells, kMostCellsAStep * steps_of(beams))) {
    grid.mark(beams);
    grid.for_each_row(update);
  } else {
    MarkedBlocks blocks;
    blocks.mark(beams);
    blocks.for_each_row(update);
  }
  sort_by_key(changes);
  return changes;
}

std::vector<CellChange> VoxelMap::declare_free(const Vec3& center, double radius_m) {
  Storage& s = *storage_;
  ++s.revision;
  std::vector<CellChange> changes;
  const Vec3 radius = Vec3::Constant(radius_m);
  const CellKey low = key_of(center - radius), high = key_of(center + radius);
  if (!in_world(low) || !in_world(high)) return changes;
  for (std::int32_t x = low.x; x <= high.x; ++x)
    for (std::int32_t y = low.y; y <= high.y; ++y)
      for (std::int32_t z = low.z; z <= high.z; ++z) {
        const CellKey k{x, y, z};
        if ((center_of(k) - center).norm() > radius_m || at(k) != Cell::unknown) continue;
        const BlockId id = block_of(k);
        s.set(s.blocks.find_or_add(id), corner_of(id), local_of(k), s.miss, changes);
      }
  sort_by_key(changes);
  return changes;
}

std::vector<CellChange> VoxelMap::fill_unknown(std::span<const CellValue> cells) {
  Storage& s = *storage_;
  ++s.revision;
  std::vector<CellChange> changes;
  for (const CellValue& c : cells) {
    if (!in_world(c.key) || at(c.key) != Cell::unknown) continue;
    const BlockId id = block_of(c.key);
    const float value = std::round(c.log_odds * kLogOddsScale);
    s.set(s.blocks.find_or_add(id), corner_of(id), local_of(c.key),
          static_cast<std::int16_t>(std::clamp<float>(value, s.low, s.high)), changes);
  }
  sort_by_key(changes);
  return changes;
}

void VoxelMap::assign(const CellKey& low, std::int32_t edge_cells, float log_odds) {
  Storage& s = *storage_;
  ++s.revision;
  const float limit = kLogOddsScale * 8 - 1;
  const auto value =
      static_cast<std::int16_t>(std::clamp(std::round(log_odds * kLogOddsScale), -limit, limit));
  const auto clamped = [](std::int64_t v) {
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(v, -kWorldCells, kWorldCells));
  };
  const CellKey from{clamped(low.x), clamped(low.y), clamped(low.z)};
  const auto end = [&](std::int32_t v) { return clamped(std::int64_t{v} + edge_cells); };
  std::vector<CellChange> changes;
  for (std::int32_t x = from.x; x < end(low.x); ++x)
    for (std::int32_t y = from.y; y < end(low.y); ++y)
      for (std::int32_t z = from.z; z < end(low.z); ++z) {
        const BlockId id = block_of({x, y, z});
        s.set(s.blocks.find_or_add(id), corner_of(id), local_of({x, y, z}), value, changes);
        changes.clear();
      }
}

}  // namespace karst::core
