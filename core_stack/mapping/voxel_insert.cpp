// Writing to the map: one scan's rays, or a ball declared free.
#include <bit>

#include "core_stack/mapping/cell_walk.h"
#include "core_stack/mapping/voxel_storage.h"

namespace karst::core {
namespace {

/// Ends seen so far, by the cells of origin and end: rays from one cell to another say the same but once.
class RaySet {
 public:
  explicit RaySet(std::size_t rays) : slots_(std::bit_ceil(2 * rays + 1)) {}

  /// True if no such ray was there before.
  bool add(const CellKey& origin, const CellKey& end, bool hit) {
    const std::uint64_t a = packed(origin) | std::uint64_t{1} << 63;  // never zero: zero marks an empty slot
    const std::uint64_t b = packed(end) | (hit ? std::uint64_t{1} << 62 : 0);
    std::uint64_t h = (a ^ b * 0x9e3779b97f4a7c15ull) * 0xbf58476d1ce4e5b9ull;
    for (h >>= 20;; ++h) {
      Slot& s = slots_[h & (slots_.size() - 1)];
      if (s.origin == a && s.end == b) return false;
      if (s.origin != 0) continue;
      s = {a, b};
      return true;
    }
  }

 private:
  struct Slot {
    std::uint64_t origin = 0, end = 0;
  };
  static std::uint64_t packed(const CellKey& k) {
    const auto part = [](std::int32_t v) { return static_cast<std::uint64_t>(v + kWorldCells); };
    return part(k.x) << 32 | part(k.y) << 16 | part(k.z);
  }
  std::vector<Slot> slots_;
};

/// Marks cells in the blocks' bitsets and remembers which blocks it touched.
class Marker {
 public:
  explicit Marker(BlockTable& blocks) : blocks_(blocks) {}

  void hit(const CellKey& k) { mark(block(k).hit, k); }
  void miss(const CellKey& k) { mark(block(k).miss, k); }
  const std::vector<Block*>& touched() const { return touched_; }

 private:
  static void mark(std::array<std::uint64_t, 8>& bits, const CellKey& k) {
    const std::uint32_t i = local_of(k);
    bits[i >> 6] |= std::uint64_t{1} << (i & 63);
  }
  Block& block(const CellKey& k) {
    const BlockId id = block_of(k);
    if (last_ != nullptr && last_->id == id) return *last_;
    last_ = &blocks_.find_or_add(id);
    if (!last_->touched) last_->touched = true, touched_.push_back(last_);
    return *last_;
  }

  BlockTable& blocks_;
  Block* last_ = nullptr;
  std::vector<Block*> touched_;
};

void sort_by_key(std::vector<CellChange>& changes) {
  std::sort(changes.begin(), changes.end(),
            [](const CellChange& a, const CellChange& b) { return a.key < b.key; });
}

template <class Visit>
void for_each_bit(const std::array<std::uint64_t, 8>& bits, Visit&& visit) {
  for (std::uint32_t w = 0; w < bits.size(); ++w)
    for (std::uint64_t rest = bits[w]; rest != 0; rest &= rest - 1)
      visit(w * 64 + static_cast<std::uint32_t>(std::countr_zero(rest)));
}

}  // namespace

std::vector<CellChange> VoxelMap::insert(std::span<const Ray> rays) {
  Storage& s = *storage_;
  ++s.revision;
  RaySet seen(rays.size());
  Marker marker(s.blocks);
  for (const Ray& ray : rays) {
    const Vec3 from = ray.origin.cast<double>(), to = ray.end.cast<double>();
    const CellKey origin = key_of(from), end = key_of(to);
    if (!in_world(origin) || !in_world(end) || !seen.add(origin, end, ray.hit)) continue;
    walk_cells(from * s.cells_per_m, to * s.cells_per_m, [&](const CellKey& k) {
      if (k != end) marker.miss(k);
      return true;
    });
    if (ray.hit) marker.hit(end);
  }

  std::vector<CellChange> changes;
  for (Block* b : marker.touched()) {
    const CellKey corner = corner_of(b->id);
    const auto add = [&](std::uint32_t i, std::int16_t step) {
      const int before = b->log_odds[i] == kUnknown ? 0 : b->log_odds[i];
      s.set(*b, corner, i, static_cast<std::int16_t>(std::clamp<int>(before + step, s.low, s.high)), changes);
    };
    for (std::size_t w = 0; w < b->miss.size(); ++w) b->miss[w] &= ~b->hit[w];
    for_each_bit(b->hit, [&](std::uint32_t i) { add(i, s.hit); });
    for_each_bit(b->miss, [&](std::uint32_t i) { add(i, s.miss); });
    b->hit.fill(0), b->miss.fill(0), b->touched = false;
  }
  sort_by_key(changes);
  return changes;
}

std::vector<CellChange> VoxelMap::declare_free(const Vec3& center, double radius_m) {
  Storage& s = *storage_;
  ++s.revision;
  std::vector<CellChange> changes;
  const Vec3 reach = Vec3::Constant(radius_m);
  const CellKey low = key_of(center - reach), high = key_of(center + reach);
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
