#include "core_stack/planning/roadmap/roadmap_graph.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace karst::core {
namespace {

/// Extracts the cells of block b from the rows of its tile.
BlockBits block_bits(const TileBits& rows, std::uint32_t b) {
  const std::uint32_t bx = b & 7, by = b >> 3 & 1, bz = b >> 4;
  BlockBits out = 0;
  for (std::uint32_t z = 0; z < 4; ++z)
    for (std::uint32_t y = 0; y < 4; ++y) {
      const BlockBits four = rows[(by * 4 + y) | (bz * 4 + z) << 3] >> (bx * 4) & 15;
      out |= four << (y * 4 + z * 16);
    }
  return out;
}

/// Twice the squared distance, in cells, of each cell from the block's centre.
int eccentricity(int bit) {
  const int x = 2 * (bit & 3) - 3, y = 2 * (bit >> 2 & 3) - 3, z = 2 * (bit >> 4) - 3;
  return x * x + y * y + z * z;
}

int middle_cell(BlockBits cells) {
  int best = std::countr_zero(cells);
  for (BlockBits rest = cells; rest != 0; rest &= rest - 1)
    if (const int bit = std::countr_zero(rest); eccentricity(bit) < eccentricity(best)) best = bit;
  return best;
}

CellKey cell_in_block(const CellKey& corner, int bit) {
  return {corner.x + (bit & 3), corner.y + (bit >> 2 & 3), corner.z + (bit >> 4)};
}

}  // namespace

void RoadmapGraph::update(const VoxelMap& map, std::span<const CellChange> changes) {
  if (!rule) {
    free = FreeTiles(map.resolution_m());
    clearance_m = search_clearance_m(options, map.resolution_m());
    rule.emplace(options.clearance_m / map.resolution_m(), clearance_m / map.resolution_m());
  }
  ++updates;
  std::vector<std::uint32_t> dirty;
  for (const CellChange& c : changes) {
    free.refresh(map, c.key);
    mark_dirty(c.key, dirty);
  }
  for (const std::uint32_t i : dirty) rebuild(i);
}

std::uint32_t RoadmapGraph::add_tile(const TileKey& t) {
  const std::uint32_t added = table.add(t);
  tiles.emplace_back();
  for (std::int32_t i = 0; i < 27; ++i) {
    const std::uint32_t other = table.find({t.x + i % 3 - 1, t.y + i / 3 % 3 - 1, t.z + i / 9 - 1});
    tiles[added].around[static_cast<std::size_t>(i)] = other;
    if (other != TileTable::none) tiles[other].around[static_cast<std::size_t>(26 - i)] = added;
  }
  return added;
}

void RoadmapGraph::mark_dirty(const CellKey& k, std::vector<std::uint32_t>& dirty) {
  const int r = rule->extent();
  const TileKey a = tile_of({k.x - r, k.y - r, k.z - r}), b = tile_of({k.x + r, k.y + r, k.z + r});
  for (std::int32_t z = a.z; z <= b.z; ++z)
    for (std::int32_t y = a.y; y <= b.y; ++y)
      for (std::int32_t x = a.x; x <= b.x; ++x) {
        std::uint32_t i = table.find({x, y, z});
        if (i == TileTable::none) i = add_tile({x, y, z});
        if (!tiles[i].dirty) dirty.push_back(i);
        tiles[i].dirty = true;
        tiles[i].touched = updates;
      }
}

void RoadmapGraph::rebuild(std::uint32_t tile_index) {
  RoadmapTile& tile = tiles[tile_index];
  tile.dirty = false;
  const TileBits rows = free.clear_cells(table.keys()[tile_index], *rule);
  const std::vector<RoadmapNode> before = std::exchange(tile.nodes, {});
  const CellKey corner = corner_of(table.keys()[tile_index]);
  for (std::uint32_t b = 0; b < kTileBlocks; ++b) {
    tile.first[b] = static_cast<std::uint16_t>(tile.nodes.size());
    const auto n = static_cast<std::int32_t>(b);
    const CellKey block_corner = corner + CellKey{(n & 7) * 4, (n >> 3 & 1) * 4, (n >> 4) * 4};
    for (BlockBits rest = block_bits(rows, b); rest != 0;) {
      const BlockBits part = first_component(rest);
      tile.nodes.push_back({part, cell_in_block(block_corner, middle_cell(part))});
      rest &= ~part;
    }
  }
  tile.first[kTileBlocks] = static_cast<std::uint16_t>(tile.nodes.size());
  if (tile.nodes != before) tile.changed = updates;
}

bool RoadmapGraph::links_stand(std::uint32_t tile_index) const {
  const std::uint64_t as_of = links_[tile_index].as_of;
  const auto& around = tiles[tile_index].around;  // itself as well
  return as_of > 0 && std::all_of(around.begin(), around.end(), [&](std::uint32_t i) {
           return i == TileTable::none || tiles[i].changed <= as_of;
         });
}

void RoadmapGraph::link(std::uint32_t tile_index) const {
  TileLinks& of = links_[tile_index];
  of.first.assign(1, 0);
  of.links.clear();
  for (std::uint32_t n = 0; n < tiles[tile_index].nodes.size(); ++n) {
    const Vec3 p = position_of({tile_index, n});
    for_each_neighbour({tile_index, n}, [&](const NodeRef& m) {
      of.links.push_back({(position_of(m) - p).norm(), m});
    });
    of.first.push_back(static_cast<std::uint32_t>(of.links.size()));
  }
}

const std::vector<TileLinks>& RoadmapGraph::links() const {
  const std::lock_guard lock(kept_);
  if (linked_ == updates) return links_;
  linked_ = updates;
  links_.resize(tiles.size());
  for (std::uint32_t i = 0; i < tiles.size(); ++i) {
    if (!links_stand(i)) link(i);
    links_[i].as_of = updates;
  }
  return links_;
}

/// Whether a cell has changed since that may alter the joins of p. They look at the blocks around that of p,
/// and at what lies nearer to the lines there than the clearance.
bool RoadmapGraph::touched_after(std::uint64_t update, const Vec3& p) const {
  const CellKey k = free.key_of(p);
  const std::int32_t r = 9 + static_cast<std::int32_t>(std::ceil(clearance_m / free.resolution_m()));
  const TileKey a = tile_of({k.x - r, k.y - r, k.z - r}), b = tile_of({k.x + r, k.y + r, k.z + r});
  for (std::int32_t z = a.z; z <= b.z; ++z)
    for (std::int32_t y = a.y; y <= b.y; ++y)
      for (std::int32_t x = a.x; x <= b.x; ++x)
        if (const std::uint32_t i = table.find({x, y, z}); i != TileTable::none && tiles[i].touched > update)
          return true;
  return false;
}

std::vector<Join> RoadmapGraph::kept_joins(const Vec3& p) const {
  constexpr std::size_t kMost = 2000;
  const std::lock_guard lock(kept_);
  if (joins_of_.size() > kMost) joins_of_.clear();
  KeptJoins& kept = joins_of_[{p.x(), p.y(), p.z()}];
  if (kept.as_of == 0 || touched_after(kept.as_of, p)) kept.joins = joins(p);
  kept.as_of = updates;
  return kept.joins;
}

std::vector<Join> RoadmapGraph::joins(const Vec3& p) const {
  std::vector<Join> out;
  const auto add = [&out](const NodeRef& n, double length_m, std::optional<CellKey> via) {
    for (Join& j : out)
      if (j.node.tile == n.tile && j.node.local == n.local) {
        if (length_m < j.length_m) {
          j.length_m = length_m;
          j.via = via;
        }
        return;
      }
    out.push_back({n, length_m, via});
  };
  const CellKey k = free.key_of(p);
  for (int i = 0; i < 27; ++i) {
    const CellKey d{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
    for_each_node_in_block(k + CellKey{4 * d.x, 4 * d.y, 4 * d.z}, [&](const NodeRef& n, const RoadmapNode&) {
      const Vec3 q = position_of(n);
      if (free.segment_clear(p, q, clearance_m)) add(n, (q - p).norm(), std::nullopt);
    });
    const CellKey c = k + d;
    const Vec3 q = free.center_of(c);
    const int bit = (c.x & 3) | (c.y & 3) << 2 | (c.z & 3) << 4;
    for_each_node_in_block(c, [&](const NodeRef& n, const RoadmapNode& node) {
      if ((node.cells >> bit & 1) && free.segment_clear(p, q, clearance_m))
        add(n, (q - p).norm() + (position_of(n) - q).norm(), c);
    });
  }
  return out;
}

std::vector<CellKey> RoadmapGraph::cells_between(const CellKey& a, const CellKey& b) const {
  const CellKey low{std::min(a.x, b.x) & ~3, std::min(a.y, b.y) & ~3, std::min(a.z, b.z) & ~3};
  const CellKey high{std::max(a.x, b.x) | 3, std::max(a.y, b.y) | 3, std::max(a.z, b.z) | 3};
  constexpr int kEdge = 8, kCells = kEdge * kEdge * kEdge;  // neighbouring blocks: at most two per axis
  const auto index = [&](const CellKey& k) {
    return ((k.z - low.z) * kEdge + k.y - low.y) * kEdge + k.x - low.x;
  };
  const auto cell = [&](int i) {
    return CellKey{low.x + i % kEdge, low.y + i / kEdge % kEdge, low.z + i / (kEdge * kEdge)};
  };
  std::array<BlockBits, 8> clear{};
  for (int i = 0; i < 8; ++i)
    if (const CellKey k = low + CellKey{4 * (i & 1), 4 * (i >> 1 & 1), 4 * (i >> 2)};
        k.x <= high.x && k.y <= high.y && k.z <= high.z)
      for_each_node_in_block(
          k, [&](const NodeRef&, const RoadmapNode& n) { clear[static_cast<std::size_t>(i)] |= n.cells; });
  const auto is_clear = [&](int i) {
    const int x = i % kEdge, y = i / kEdge % kEdge, z = i / (kEdge * kEdge);
    return (clear[static_cast<std::size_t>(x >> 2 | (y >> 2) << 1 | (z >> 2) << 2)] >>
                ((x & 3) | (y & 3) << 2 | (z & 3) << 4) &
            1) != 0;
  };
  // Breadth first from b, so that following the parents from a leads to b.
  std::array<std::int16_t, kCells> parent, queue;
  parent.fill(-1);
  int queued = 0;
  const auto reach = [&](int i, int by) {
    parent[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(by);
    queue[static_cast<std::size_t>(queued++)] = static_cast<std::int16_t>(i);
  };
  reach(index(b), index(b));
  for (int i = 0; i < queued && parent[static_cast<std::size_t>(index(a))] < 0; ++i) {
    const int at = queue[static_cast<std::size_t>(i)];
    for (int m = 0; m < 27; ++m) {
      const CellKey n = cell(at) + CellKey{m % 3 - 1, m / 3 % 3 - 1, m / 9 - 1};
      if (n.x < low.x || n.y < low.y || n.z < low.z || n.x > high.x || n.y > high.y || n.z > high.z) continue;
      if (const int j = index(n); parent[static_cast<std::size_t>(j)] < 0 && is_clear(j)) reach(j, at);
    }
  }
  std::vector<CellKey> out{a};
  while (!(out.back() == b)) {
    const int at = parent[static_cast<std::size_t>(index(out.back()))];
    if (at < 0) break;
    out.push_back(cell(at));
  }
  return out;
}

}  // namespace karst::core
