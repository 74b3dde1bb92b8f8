#include "core_stack/planning/roadmap/distance_tree.h"

#include <algorithm>
#include <limits>

#include "core_stack/planning/roadmap/roadmap_path.h"

namespace karst::core {
namespace {

constexpr double kUnreached_m = std::numeric_limits<double>::infinity();
/// Special values of the next cell that are not the cell of any node.
constexpr CellKey kNothing{std::numeric_limits<std::int32_t>::max(), 0, 0};
constexpr CellKey kRootCell{std::numeric_limits<std::int32_t>::min(), 0, 0};

struct PastNode {
  std::uint32_t tile;
  RoadmapNode node;
};

struct Entry {
  double length_m;
  NodeRef node;
  bool operator<(const Entry& o) const {
    if (length_m != o.length_m) return length_m > o.length_m;
    return node.tile != o.node.tile ? node.tile > o.node.tile : node.local > o.node.local;
  }
};

}  // namespace

struct DistanceTree::Tree {
  /// A tile of the roadmap as last seen by the tree. A node is identified by its cell: no two share one.
  struct TreeTile {
    std::uint64_t seen = 0;
    std::vector<RoadmapNode> nodes;
    std::vector<double> length_m;  // to the root
    std::vector<CellKey> next;     // the cell of the next node on the path
  };

  std::optional<Vec3> root;
  std::vector<Join> joins;      // of the root
  std::vector<CellKey> joined;  // cells of their nodes
  std::vector<TreeTile> tiles;
  std::size_t touched = 0;

  double& length(const NodeRef& n) { return tiles[n.tile].length_m[n.local]; }
  double length(const NodeRef& n) const { return tiles[n.tile].length_m[n.local]; }
  CellKey& next(const NodeRef& n) { return tiles[n.tile].next[n.local]; }
  const CellKey& next(const NodeRef& n) const { return tiles[n.tile].next[n.local]; }

  void update(const RoadmapGraph& g);
  void take_over(const RoadmapGraph& g, std::uint32_t tile, std::vector<PastNode>& gone,
                 std::vector<NodeRef>& lost);
  void check_joins(const RoadmapGraph& g, std::vector<PastNode>& gone, std::vector<NodeRef>& lost);
  void forget_paths_through(const RoadmapGraph& g, std::vector<PastNode> gone, std::vector<NodeRef>& lost);
  void relax(const RoadmapGraph& g, const std::vector<NodeRef>& lost);
  void forget(const NodeRef& n, std::vector<PastNode>& gone, std::vector<NodeRef>& lost) {
    length(n) = kUnreached_m;
    next(n) = kNothing;
    lost.push_back(n);
    gone.push_back({n.tile, tiles[n.tile].nodes[n.local]});
  }
  std::optional<Join> best_join(const RoadmapGraph& g, const Vec3& from, double& length_m) const;
};

/// Copies the tile's current nodes; nodes that existed before keep their lengths.
void DistanceTree::Tree::take_over(const RoadmapGraph& g, std::uint32_t tile, std::vector<PastNode>& gone,
                                   std::vector<NodeRef>& lost) {
  const TreeTile before = std::exchange(tiles[tile], {});
  TreeTile& now = tiles[tile];
  now.seen = g.updates;
  now.nodes = g.tiles[tile].nodes;
  now.length_m.assign(now.nodes.size(), kUnreached_m);
  now.next.assign(now.nodes.size(), kNothing);
  std::vector<char> kept(before.nodes.size(), false);
  for (std::uint32_t i = 0; i < now.nodes.size(); ++i) {
    const auto same =
        std::find(before.nodes.begin(), before.nodes.end(), now.nodes[i]) - before.nodes.begin();
    const auto k = static_cast<std::size_t>(same);
    if (k < before.nodes.size()) {
      now.length_m[i] = before.length_m[k];
      now.next[i] = before.next[k];
      kept[k] = true;
    } else {
      lost.push_back({tile, i});
    }
  }
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (!kept[k] && before.length_m[k] < kUnreached_m) gone.push_back({tile, before.nodes[k]});
}

/// Invalidates nodes whose direct connection to the root is gone or has changed.
void DistanceTree::Tree::check_joins(const RoadmapGraph& g, std::vector<PastNode>& gone,
                                     std::vector<NodeRef>& lost) {
  const std::vector<Join> old_joins = std::exchange(joins, {});
  const std::vector<CellKey> old_joined = std::exchange(joined, {});
  if (g.free.is_clear(*root, g.clearance_m)) joins = g.joins(*root);
  for (const Join& j : joins) joined.push_back(g.cell_of(j.node));
  for (std::size_t i = 0; i < old_joins.size(); ++i) {
    bool stands = false;
    for (std::size_t k = 0; k < joins.size(); ++k)
      stands |= joined[k] == old_joined[i] && joins[k].length_m == old_joins[i].length_m;
    if (stands) continue;
    g.for_each_node_in_block(old_joined[i], [&](const NodeRef& n, const RoadmapNode& node) {
      if (node.place == old_joined[i] && next(n) == kRootCell) forget(n, gone, lost);
    });
  }
}

void DistanceTree::Tree::forget_paths_through(const RoadmapGraph& g, std::vector<PastNode> gone,
                                              std::vector<NodeRef>& lost) {
  while (!gone.empty()) {
    const PastNode past = gone.back();
    gone.pop_back();
    g.for_each_touching(past.tile, past.node, [&](const NodeRef& n) {
      if (next(n) == past.node.place) forget(n, gone, lost);
    });
  }
}

/// Dijkstra's algorithm, starting from the offers of the lost nodes' neighbours and of the root's joins.
void DistanceTree::Tree::relax(const RoadmapGraph& g, const std::vector<NodeRef>& lost) {
  std::vector<Entry> heap;
  const auto offer = [&](const NodeRef& n, double length_m, const CellKey& by) {
    // Of equally long paths the one with the smallest cell wins, so the result does not depend on history.
    if (length_m == length(n) && by < next(n)) next(n) = by;
    if (length_m >= length(n)) return;
    length(n) = length_m;
    next(n) = by;
    heap.push_back({length_m, n});
    std::push_heap(heap.begin(), heap.end());
  };
  for (std::size_t i = 0; i < joins.size(); ++i) offer(joins[i].node, joins[i].length_m, kRootCell);
  // Collect the neighbours' offers first. An offer based on another lost node would be correct, but push
  // entries that become stale.
  std::vector<std::pair<double, CellKey>> offers(lost.size(), {kUnreached_m, kNothing});
  for (std::size_t i = 0; i < lost.size(); ++i) {
    const Vec3 p = g.position_of(lost[i]);
    g.for_each_neighbour(lost[i], [&](const NodeRef& m) {
      if (length(m) == kUnreached_m) return;
      offers[i] = std::min(offers[i], {length(m) + (g.position_of(m) - p).norm(), g.cell_of(m)});
    });
  }
  for (std::size_t i = 0; i < lost.size(); ++i)
    if (offers[i].first < kUnreached_m) offer(lost[i], offers[i].first, offers[i].second);

  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end());
    const Entry top = heap.back();
    heap.pop_back();
    if (top.length_m != length(top.node)) continue;
    ++touched;
    const Vec3 p = g.position_of(top.node);
    const CellKey place = g.cell_of(top.node);
    g.for_each_neighbour(
        top.node, [&](const NodeRef& m) { offer(m, top.length_m + (g.position_of(m) - p).norm(), place); });
  }
}

void DistanceTree::Tree::update(const RoadmapGraph& g) {
  tiles.resize(g.tiles.size());
  std::vector<PastNode> gone;
  std::vector<NodeRef> lost;  // nodes that currently have no path
  for (std::uint32_t i = 0; i < tiles.size(); ++i)
    if (g.tiles[i].changed > tiles[i].seen) take_over(g, i, gone, lost);
  check_joins(g, gone, lost);
  forget_paths_through(g, std::move(gone), lost);
  touched = lost.size();
  relax(g, lost);
}

std::optional<Join> DistanceTree::Tree::best_join(const RoadmapGraph& g, const Vec3& from,
                                                  double& length_m) const {
  std::optional<Join> best;
  length_m = kUnreached_m;
  for (const Join& j : g.joins(from))
    if (j.length_m + length(j.node) < length_m) {
      length_m = j.length_m + length(j.node);
      best = j;
    }
  return best;
}

DistanceTree::DistanceTree() : tree_(std::make_unique<Tree>()) {}
DistanceTree::~DistanceTree() = default;
DistanceTree::DistanceTree(DistanceTree&&) noexcept = default;
DistanceTree& DistanceTree::operator=(DistanceTree&&) noexcept = default;

void DistanceTree::update(const Roadmap& roadmap, const Vec3& root) {
  if (!roadmap.graph().rule) return;
  if (tree_->root != root) *tree_ = Tree{};
  tree_->root = root;
  tree_->update(roadmap.graph());
}

std::size_t DistanceTree::touched() const { return tree_->touched; }

std::optional<double> DistanceTree::length_m(const VoxelMap& map, const Roadmap& roadmap,
                                             const Vec3& from) const {
  const RoadmapGraph& g = roadmap.graph();
  if (!tree_->root || !g.rule) return std::nullopt;
  const std::vector<Vec3> escape = path_to_clear(map, g, from);
  double length_m = kUnreached_m;
  if (escape.empty() || !tree_->best_join(g, escape.back(), length_m)) return std::nullopt;
  return path_length_m(escape) + length_m;
}

std::optional<double> DistanceTree::estimated_length_m(const Roadmap& roadmap, const Vec3& from) const {
  const RoadmapGraph& g = roadmap.graph();
  if (!tree_->root || !g.rule) return std::nullopt;
  double best_m = kUnreached_m;
  const auto by = [&](const NodeRef& n) {
    best_m = std::min(best_m, (g.position_of(n) - from).norm() + tree_->length(n));
    for (const Join& j : tree_->joins)
      if (j.node.tile == n.tile && j.node.local == n.local)
        best_m = std::min(best_m, (*tree_->root - from).norm());
  };
  const CellKey k = g.free.key_of(from);
  const int bit = (k.x & 3) | (k.y & 3) << 2 | (k.z & 3) << 4;
  g.for_each_node_in_block(k, [&](const NodeRef& n, const RoadmapNode& node) {
    if (!(node.cells >> bit & 1)) return;
    by(n);
    g.for_each_neighbour(n, by);
  });
  return best_m < kUnreached_m ? std::optional(best_m) : std::nullopt;
}

Path DistanceTree::find(const VoxelMap& map, const Roadmap& roadmap, const Vec3& from) const {
  const RoadmapGraph& g = roadmap.graph();
  Path path;
  const auto fail = [&path](PlanStatus status, const char* reason) {
    path = Path{};
    path.status = status;
    path.reason = reason;
    return path;
  };
  if (!tree_->root || !g.rule) return fail(PlanStatus::no_path, "the roadmap is empty");
  path.points = path_to_clear(map, g, from);
  if (path.points.empty())
    return fail(PlanStatus::start_blocked,
                "the start is nearer to an obstacle than the clearance and no way leads out");
  path.escape_points = path.points.size() - 1;
  double length_m = kUnreached_m;
  const std::optional<Join> out = tree_->best_join(g, path.points.back(), length_m);
  if (!out) return fail(PlanStatus::no_path, "no way through known free space leads home");

  std::vector<NodeRef> nodes{out->node};
  for (CellKey next = tree_->next(out->node); next != kRootCell; next = tree_->next(nodes.back())) {
    const std::size_t before = nodes.size();
    g.for_each_node_in_block(next, [&](const NodeRef& n, const RoadmapNode& node) {
      if (node.place == next) nodes.push_back(n);
    });
    if (nodes.size() == before) return fail(PlanStatus::no_path, "the way home is out of date");
  }
  for (std::size_t i = 0; i < tree_->joins.size(); ++i)
    if (tree_->joined[i] == g.cell_of(nodes.back()))
      append_path(g, *out, nodes, tree_->joins[i], *tree_->root, path.points);
  path.status = PlanStatus::found;
  measure(path, kUnreached_m);
  return path;
}

}  // namespace karst::core
