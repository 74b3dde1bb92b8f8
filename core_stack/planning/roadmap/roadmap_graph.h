// The roadmap's data: clear cells by tile, and the nodes built from them. Private to planning.
#pragma once
#include <map>
#include <mutex>

#include "core_stack/planning/free_space/block_bits.h"
#include "core_stack/planning/free_space/free_tiles.h"
#include "core_stack/planning/roadmap/roadmap.h"

namespace karst::core {

constexpr std::uint32_t kTileBlocks = 32;  // 8 x 2 x 2 blocks; index x | y << 3 | z << 4

struct RoadmapNode {
  BlockBits cells = 0;
  CellKey place;  // the cell of its position
  bool operator==(const RoadmapNode&) const = default;
};

/// A node's identifier: its tile, and its index in the tile's list.
struct NodeRef {
  std::uint32_t tile = 0, local = 0;
};

/// The way from a node to one that it is joined to.
struct RoadmapLink {
  double length_m;
  NodeRef node;
};

/// The links of a tile's nodes.
struct TileLinks {
  std::uint64_t as_of = 0;           // the update that they were last compared with
  std::vector<std::uint32_t> first;  // links of node n: first[n] to first[n + 1]
  std::vector<RoadmapLink> links;
};

struct RoadmapTile {
  std::array<std::uint16_t, kTileBlocks + 1> first{};  // nodes of block b: first[b] to first[b + 1]
  std::vector<RoadmapNode> nodes;
  std::array<std::uint32_t, 27>
      around;  // the tile at (dx, dy, dz), each -1, 0, 1: index dx + 1 + 3 (dy + 1) + 9 (dz + 1)
  bool dirty = false;
  std::uint64_t changed = 0;  // the update, counted from 1, that last changed its nodes
  std::uint64_t touched = 0;  // the update that last changed a cell in it or near it
};

/// A connection from a point to a node, straight or through the cell `via`.
struct Join {
  NodeRef node;
  double length_m = 0;
  std::optional<CellKey> via;
};

struct RoadmapGraph {
  explicit RoadmapGraph(const PlanningOptions& o) : options(o), free(0) {}

  PlanningOptions options;
  double clearance_m = 0;  // of the search; set by the first update
  FreeTiles free;          // of the map as of the last update
  std::optional<ClearanceRule> rule;
  TileTable table;
  std::vector<RoadmapTile> tiles;
  std::uint64_t updates = 0;

  void update(const VoxelMap& map, std::span<const CellChange> changes);
  const CellKey& cell_of(const NodeRef& n) const { return tiles[n.tile].nodes[n.local].place; }
  Vec3 position_of(const NodeRef& n) const { return free.center_of(cell_of(n)); }
  /// Nodes of the block that holds cell k: calls visit(NodeRef, const RoadmapNode&).
  template <class Visit>
  void for_each_node_in_block(const CellKey& k, Visit&& visit) const {
    for_each_node_in_block(table.find(tile_of(k)), k, visit);
  }
  /// Nodes joined to n: calls visit(NodeRef).
  template <class Visit>
  void for_each_neighbour(const NodeRef& n, Visit&& visit) const {
    for_each_touching(n.tile, tiles[n.tile].nodes[n.local], visit);
  }
  /// Nodes that a present or former node of tile `tile_index` is joined to.
  template <class Visit>
  void for_each_touching(std::uint32_t tile_index, const RoadmapNode& node, Visit&& visit) const {
    const RoadmapTile& tile = tiles[tile_index];
    const TileKey home = table.keys()[tile_index];
    for (int i = 0; i < 27; ++i) {
      const int dx = i % 3 - 1, dy = i / 3 % 3 - 1, dz = i / 9 - 1;
      if (i == 13) continue;
      const BlockBits touched = touched_in_neighbour(node.cells, dx, dy, dz);
      if (touched == 0) continue;
      const CellKey there = node.place + CellKey{4 * dx, 4 * dy, 4 * dz};
      const TileKey t = tile_of(there);
      const std::int32_t side = t.x - home.x + 3 * (t.y - home.y) + 9 * (t.z - home.z) + 13;
      for_each_node_in_block(tile.around[static_cast<std::size_t>(side)], there,
                             [&](const NodeRef& m, const RoadmapNode& other) {
                               if (other.cells & touched) visit(m);
                             });
    }
  }
  /// All links, by tile; in the order of for_each_neighbour. What has not changed since the last call is
  /// kept. Valid until the next update. Any thread may call it.
  const std::vector<TileLinks>& links() const;
  /// Connections from a clear point into the graph.
  std::vector<Join> joins(const Vec3& p) const;
  /// The same for a point that is asked for again and again: kept until a cell changes near it. Any thread
  /// may call it.
  std::vector<Join> kept_joins(const Vec3& p) const;
  /// Clear cells from a to b, both included, in the blocks that contain them. They must be connected there.
  std::vector<CellKey> cells_between(const CellKey& a, const CellKey& b) const;

 private:
  /// The same with a known tile; TileTable::none has no nodes.
  template <class Visit>
  void for_each_node_in_block(std::uint32_t tile_index, const CellKey& k, Visit&& visit) const {
    if (tile_index == TileTable::none) return;
    const RoadmapTile& tile = tiles[tile_index];
    const auto b = static_cast<std::uint32_t>((k.x >> 2 & 7) | (k.y >> 2 & 1) << 3 | (k.z >> 2 & 1) << 4);
    for (std::uint32_t n = tile.first[b]; n < tile.first[b + 1]; ++n)
      visit(NodeRef{tile_index, n}, tile.nodes[n]);
  }
  std::uint32_t add_tile(const TileKey& t);
  void mark_dirty(const CellKey& k, std::vector<std::uint32_t>& dirty);
  void rebuild(std::uint32_t tile_index);
  bool links_stand(std::uint32_t tile_index) const;
  void link(std::uint32_t tile_index) const;
  bool touched_after(std::uint64_t update, const Vec3& p) const;

  // What the searches found out of the data above, and may find again.
  struct KeptJoins {
    std::uint64_t as_of = 0;
    std::vector<Join> joins;
  };
  mutable std::mutex kept_;
  mutable std::vector<TileLinks> links_;
  mutable std::uint64_t linked_ = 0;  // the update that the links are of
  mutable std::map<std::array<double, 3>, KeptJoins> joins_of_;
};

}  // namespace karst::core
