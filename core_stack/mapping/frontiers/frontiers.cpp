#include "core_stack/mapping/frontiers/frontiers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <optional>

#include "core_stack/mapping/occupancy/packed_cell.h"
#include "core_stack/mapping/occupancy/voxel_reader.h"
#include "core_stack/mapping/region/flight_region.h"

namespace karst::core {
namespace {

std::int32_t floor_div(std::int32_t a, std::int32_t b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

template <class Key>
void sort_unique(std::vector<Key>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

/// Whether the region leaves the cell to be explored: what lies outside of it is nothing to look for.
bool explorable(const VoxelMap& map, PackedCell p) {
  return !map.region() || map.region()->contains(map.center_of(unpack(p)));
}

/// What leads from a cell to its neighbours, in the order of kFaces.
constexpr auto kPackedFaces = [] {
  std::array<PackedCell, kFaces.size()> steps{};
  for (std::size_t i = 0; i < kFaces.size(); ++i) steps[i] = pack(kFaces[i]) - pack({});
  return steps;
}();

/// The cells around a cell, with one reader per direction: between neighbouring cells it stays in its block.
class FaceReaders {
 public:
  explicit FaceReaders(const VoxelMap& map)
      : map_(map), readers_{VoxelReader(map), VoxelReader(map), VoxelReader(map),
                            VoxelReader(map), VoxelReader(map), VoxelReader(map)} {}
  bool unknown(PackedCell p, std::size_t face) {
    return readers_[face].at(p + kPackedFaces[face]) == Cell::unknown &&
           explorable(map_, p + kPackedFaces[face]);
  }
  bool any_unknown(PackedCell p) {
    for (std::size_t face = 0; face < kFaces.size(); ++face)
      if (unknown(p, face)) return true;
    return false;
  }

 private:
  const VoxelMap& map_;
  std::array<VoxelReader, kFaces.size()> readers_;
};

/// The changed cells, and the neighbours of those that are no longer unknown: sorted, each once. Sorted cells
/// stay so if all are shifted by one face: lists are merged, which takes less than sorting them all.
std::vector<PackedCell> cells_concerned(std::span<const CellChange> changes) {
  std::vector<PackedCell> cells, became_known, shifted, merged;
  for (const CellChange& c : changes) {
    cells.push_back(pack(c.key));
    if (c.before == Cell::unknown) became_known.push_back(cells.back());
  }
  for (auto* list : {&cells, &became_known})
    if (!std::is_sorted(list->begin(), list->end())) std::sort(list->begin(), list->end());
  for (const PackedCell step : kPackedFaces) {
    shifted.clear();
    for (const PackedCell p : became_known) shifted.push_back(p + step);
    merged.clear();
    std::set_union(cells.begin(), cells.end(), shifted.begin(), shifted.end(), std::back_inserter(merged));
    cells.swap(merged);
  }
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

/// Number of cells in both of two sorted lists.
std::size_t shared(const std::vector<CellKey>& a, const std::vector<CellKey>& b) {
  std::size_t n = 0;
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    if (*i == *j) {
      ++n;
      ++i;
      ++j;
    } else if (*i < *j) {
      ++i;
    } else {
      ++j;
    }
  }
  return n;
}

/// The box in which a cluster's free and unknown cells are counted.
struct CellBox {
  CellKey low, high;
  CellBox(const VoxelMap& map, const FrontierCluster& c, double radius_m)
      : low(map.key_of(c.centroid - Vec3::Constant(radius_m))),
        high(map.key_of(c.centroid + Vec3::Constant(radius_m))) {}
};

void count_around(const VoxelMap& map, double radius_m, FrontierCluster& c) {
  const CellBox box(map, c, radius_m);
  const CellCounts counts = VoxelReader(map).count(box.low, box.high);
  c.free_cells = counts.free;
  c.unknown_cells = counts.unknown;
}

}  // namespace

void describe(OptionTable& t, FrontierOptions& o) {
  t.add("tile", o.tile_m, "m", 0.4, 12.8, "edge of the tiles that bound a cluster's size");
  t.add("min_cells", o.min_cells, 1, 1000, "clusters of fewer cells are not offered");
  t.add("neighbourhood", o.neighbourhood_m, "m", 0.2, 10,
        "half edge of the box in which free and unknown cells are counted");
}

Frontiers::Frontiers(const FrontierOptions& options) : options_(options) {}

CellKey Frontiers::tile_of(const CellKey& k) const {
  return {floor_div(k.x, edge_), floor_div(k.y, edge_), floor_div(k.z, edge_)};
}
std::size_t Frontiers::row_of(const CellKey& k, const CellKey& t) const {
  return static_cast<std::size_t>((k.x - t.x * edge_) * edge_ + k.y - t.y * edge_);
}
std::uint64_t Frontiers::bit_of(const CellKey& k, const CellKey& t) const {
  return std::uint64_t{1} << (k.z - t.z * edge_);
}

bool Frontiers::is_frontier(const CellKey& k) const {
  if (edge_ == 0) return false;
  const CellKey t = tile_of(k);
  const auto tile = tiles_.find(t);
  return tile != tiles_.end() && (tile->second.rows[row_of(k, t)] & bit_of(k, t)) != 0;
}

void Frontiers::update(const VoxelMap& map, std::span<const CellChange> changes) {
  if (changes.empty()) return;
  if (edge_ == 0)
    edge_ = std::clamp(static_cast<std::int32_t>(std::lround(options_.tile_m / map.resolution_m())), 1, 64);
  std::set<std::uint32_t> stale;  // clusters whose counts must be updated
  for (const CellKey& t : update_cells(map, changes)) {
    Tile& tile = tiles_.at(t);
    std::vector<Part> parts = components(t);
    name(parts, tile.parts);
    for (const Part& p : tile.parts) clusters_.erase(p.id);
    for (const Part& p : parts) {
      publish(map, p);
      stale.insert(p.id);
    }
    tile.parts = std::move(parts);
    if (tile.parts.empty()) tiles_.erase(t);
  }
  add_clusters_near(map, changes, stale);
  for (const std::uint32_t id : stale)
    if (const auto c = clusters_.find(id); c != clusters_.end())
      count_around(map, options_.neighbourhood_m, c->second);
}

/// Updates the frontier bits; returns the tiles that must be clustered again, sorted. These include the tiles
/// of cells that remain frontier but see less of the unknown than before.
std::vector<CellKey> Frontiers::update_cells(const VoxelMap& map, std::span<const CellChange> changes) {
  std::vector<CellKey> dirty;
  VoxelReader reader(map);
  FaceReaders faces(map);
  std::optional<CellKey> at;
  Tile* tile = nullptr;  // that of `at`; null: there is none
  for (const PackedCell candidate : cells_concerned(changes)) {
    const CellKey k = unpack(candidate), t = tile_of(k);
    if (at != t) {
      at = t;
      const auto found = tiles_.find(t);
      tile = found == tiles_.end() ? nullptr : &found->second;
    }
    const bool now =
        reader.at(candidate) == Cell::free && faces.any_unknown(candidate) && explorable(map, candidate);
    const bool before = tile != nullptr && (tile->rows[row_of(k, t)] & bit_of(k, t)) != 0;
    if (!now && !before) continue;
    if (dirty.empty() || dirty.back() != t) dirty.push_back(t);
    if (now == before) continue;
    if (tile == nullptr) tile = &tiles_[t];
    if (tile->rows.empty()) tile->rows.resize(static_cast<std::size_t>(edge_) * edge_);
    tile->rows[row_of(k, t)] ^= bit_of(k, t);
    cell_count_ = now ? cell_count_ + 1 : cell_count_ - 1;
  }
  sort_unique(dirty);
  return dirty;
}

/// The tile's frontier cells as 26-connected components, ordered by their lowest cells.
std::vector<Frontiers::Part> Frontiers::components(const CellKey& t) const {
  const std::vector<std::uint64_t>& rows = tiles_.at(t).rows;
  std::vector<std::uint64_t> left = rows;
  const auto index_of = [&](std::size_t row, int z) {
    return row * static_cast<std::size_t>(edge_) + static_cast<std::size_t>(z);
  };
  std::vector<std::uint32_t> part_of(rows.size() * static_cast<std::size_t>(edge_));
  struct Run {  // consecutive cells of one row
    std::int32_t x, y;
    std::uint64_t cells;
  };
  std::vector<Run> stack;
  std::vector<Part> parts;
  const auto take = [&](std::int32_t x, std::int32_t y, std::uint64_t cells) {
    const auto row = static_cast<std::size_t>(x * edge_ + y);
    cells &= left[row];
    if (cells == 0) return;
    left[row] &= ~cells;
    stack.push_back({x, y, cells});
    for (; cells != 0; cells &= cells - 1)
      part_of[index_of(row, std::countr_zero(cells))] = static_cast<std::uint32_t>(parts.size() - 1);
  };
  const auto flood = [&] {
    while (!stack.empty()) {
      const Run run = stack.back();
      stack.pop_back();
      const std::uint64_t around = run.cells | run.cells << 1 | run.cells >> 1;
      for (std::int32_t x = std::max(run.x - 1, 0); x <= std::min(run.x + 1, edge_ - 1); ++x)
        for (std::int32_t y = std::max(run.y - 1, 0); y <= std::min(run.y + 1, edge_ - 1); ++y)
          take(x, y, around);
    }
  };
  // In key order, so that the cells of each part are sorted.
  for (std::int32_t x = 0; x < edge_; ++x)
    for (std::int32_t y = 0; y < edge_; ++y) {
      const auto row = static_cast<std::size_t>(x * edge_ + y);
      for (std::uint64_t cells = rows[row]; cells != 0; cells &= cells - 1) {
        const auto z = std::countr_zero(cells);
        if (left[row] >> z & 1) {
          parts.emplace_back();
          take(x, y, std::uint64_t{1} << z);
          flood();
        }
        parts[part_of[index_of(row, z)]].cells.push_back({t.x * edge_ + x, t.y * edge_ + y, t.z * edge_ + z});
      }
    }
  return parts;
}

/// Each part inherits the id of the former part with which it has most cells in common; each id goes to one
/// part, and larger overlaps choose first. The other parts get new ids.
void Frontiers::name(std::vector<Part>& parts, const std::vector<Part>& former) {
  struct Claim {
    std::size_t cells, part, former;
  };
  std::vector<Claim> claims;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = 0; j < former.size(); ++j)
      if (const std::size_t n = shared(parts[i].cells, former[j].cells); n > 0) claims.push_back({n, i, j});
  std::stable_sort(claims.begin(), claims.end(),
                   [](const Claim& a, const Claim& b) { return a.cells > b.cells; });
  std::vector<bool> inherited(former.size());
  for (const Claim& c : claims) {
    if (parts[c.part].id != 0 || inherited[c.former]) continue;
    parts[c.part].id = former[c.former].id;
    inherited[c.former] = true;
  }
  for (Part& p : parts)
    if (p.id == 0) p.id = ++last_id_;
}

/// Fills everything of a cluster except the counts.
void Frontiers::publish(const VoxelMap& map, const Part& part) {
  if (static_cast<std::int64_t>(part.cells.size()) < options_.min_cells) return;
  FrontierCluster c;
  c.id = part.id;
  c.cells = part.cells;
  FaceReaders faces(map);
  CellKey sum, into_unknown;
  CellKey low = part.cells.front(), high = low;
  for (const CellKey& k : part.cells) {
    sum = sum + k;
    low = {std::min(low.x, k.x), std::min(low.y, k.y), std::min(low.z, k.z)};
    high = {std::max(high.x, k.x), std::max(high.y, k.y), std::max(high.z, k.z)};
    const PackedCell p = pack(k);
    for (std::size_t face = 0; face < kFaces.size(); ++face)
      if (faces.unknown(p, face)) into_unknown = into_unknown + kFaces[face];
  }
  const Vec3 half = Vec3::Constant(map.resolution_m() / 2);
  c.centroid = (Vec3(sum.x, sum.y, sum.z) / static_cast<double>(part.cells.size()) + Vec3::Constant(0.5)) *
               map.resolution_m();
  c.low = map.center_of(low) - half;
  c.high = map.center_of(high) + half;
  if (into_unknown != CellKey{}) c.normal = Vec3(into_unknown.x, into_unknown.y, into_unknown.z).normalized();
  clusters_[c.id] = std::move(c);
}

/// Adds the clusters in whose box a cell may have changed.
void Frontiers::add_clusters_near(const VoxelMap& map, std::span<const CellChange> changes,
                                  std::set<std::uint32_t>& ids) const {
  std::vector<CellKey> changed;
  for (const CellChange& c : changes)
    if (const CellKey t = tile_of(c.key); changed.empty() || changed.back() != t) changed.push_back(t);
  sort_unique(changed);
  // A cluster's box extends this many tiles from its centroid, which lies in its tile.
  const auto radius =
      static_cast<std::int32_t>(std::ceil(options_.neighbourhood_m / (edge_ * map.resolution_m())));
  std::vector<PackedCell> near;
  for (const CellKey& t : changed)
    for (std::int32_t dx = -radius; dx <= radius; ++dx)
      for (std::int32_t dy = -radius; dy <= radius; ++dy)
        for (std::int32_t dz = -radius; dz <= radius; ++dz) near.push_back(pack(t + CellKey{dx, dy, dz}));
  sort_unique(near);
  for (const PackedCell t : near) {
    const auto tile = tiles_.find(unpack(t));
    if (tile == tiles_.end()) continue;
    for (const Part& p : tile->second.parts) {
      const auto c = clusters_.find(p.id);
      if (c == clusters_.end()) continue;
      const CellBox box(map, c->second, options_.neighbourhood_m);
      const CellKey low = tile_of(box.low), high = tile_of(box.high);
      const bool touched = std::any_of(changed.begin(), changed.end(), [&](const CellKey& k) {
        return k.x >= low.x && k.x <= high.x && k.y >= low.y && k.y <= high.y && k.z >= low.z &&
               k.z <= high.z;
      });
      if (touched) ids.insert(p.id);
    }
  }
}

}  // namespace karst::core
