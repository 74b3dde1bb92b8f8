#include "sdk/selection/passage_graph.h"

#include <algorithm>
#include <limits>
#include <queue>

namespace karst::selection {
namespace {

using core::CellKey;

void sort_unique(std::vector<int>& v) {
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
}

/// The first 13 of the 26 neighbours: visits every pair of neighbours once.
template <class Visit>
void for_each_neighbour(const CellIndex& cells, std::size_t i, int count, const Visit& visit) {
  int n = 0;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        if (x == 0 && y == 0 && z == 0) continue;
        if (n++ == count) return;
        if (const std::int32_t j = cells.at(cells.key(i) + CellKey{x, y, z}); j >= 0)
          visit(static_cast<std::size_t>(j));
      }
}

/// Disjoint sets; each is represented by its smallest member.
class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n) {
    for (std::size_t i = 0; i < n; ++i) parent_[i] = static_cast<int>(i);
  }
  int of(int i) {
    while (parent_[static_cast<std::size_t>(i)] != i)
      i = parent_[static_cast<std::size_t>(i)] =
          parent_[static_cast<std::size_t>(parent_[static_cast<std::size_t>(i)])];
    return i;
  }
  void unite(int a, int b) {
    a = of(a);
    b = of(b);
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

/// The graph while nodes are being merged.
class Uniting {
 public:
  explicit Uniting(const std::vector<PassageNode>& nodes) : sets_(nodes.size()), nodes_(nodes) {}

  std::vector<int> below(int node) { return own(nodes_[static_cast<std::size_t>(node)].below); }

  /// Of all paths from `from` to `to` below band `top`, the one whose lowest band is highest.
  std::vector<int> highest_path(int from, int to, int top) {
    std::vector<int> came(nodes_.size(), -1);
    std::priority_queue<std::array<int, 3>> open;  // lowest band so far, node, predecessor
    open.push({band(from), from, from});
    while (!open.empty()) {
      const auto [lowest, node, before] = open.top();
      open.pop();
      if (came[static_cast<std::size_t>(node)] >= 0) continue;
      came[static_cast<std::size_t>(node)] = before;
      if (node == to) break;
      const PassageNode& n = nodes_[static_cast<std::size_t>(node)];
      for (const auto* side : {&n.below, &n.above})
        for (const int next : own(*side))
          if (band(next) < top) open.push({std::min(lowest, band(next)), next, node});
    }
    std::vector<int> path{to};
    while (path.back() != from) path.push_back(came[static_cast<std::size_t>(path.back())]);
    return path;
  }

  int lowest_band(const std::vector<int>& path) const {
    int lowest = std::numeric_limits<int>::max();
    for (const int n : path) lowest = std::min(lowest, band(n));
    return lowest;
  }

  /// Merges the nodes of a path that are of one band.
  void fold(const std::vector<int>& path) {
    for (std::size_t i = 0; i < path.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (band(path[i]) == band(path[j])) unite(path[i], path[j]);
  }

  std::vector<PassageNode> result() {
    std::vector<int> number(nodes_.size(), -1);
    std::vector<PassageNode> out;
    for (int i = 0; i < static_cast<int>(nodes_.size()); ++i)
      if (sets_.of(i) == i) {
        number[static_cast<std::size_t>(i)] = static_cast<int>(out.size());
        out.push_back(nodes_[static_cast<std::size_t>(i)]);
      }
    for (PassageNode& n : out)
      for (auto* side : {&n.below, &n.above}) {
        for (int& m : *side) m = number[static_cast<std::size_t>(sets_.of(m))];
        sort_unique(*side);
      }
    return out;
  }

 private:
  int band(int node) const { return nodes_[static_cast<std::size_t>(node)].band; }
  std::vector<int> own(const std::vector<int>& side) {
    std::vector<int> out;
    for (const int n : side) out.push_back(sets_.of(n));
    sort_unique(out);
    return out;
  }
  void unite(int a, int b) {
    a = sets_.of(a);
    b = sets_.of(b);
    if (a == b) return;
    sets_.unite(a, b);
    PassageNode& kept = nodes_[static_cast<std::size_t>(std::min(a, b))];
    const PassageNode& gone = nodes_[static_cast<std::size_t>(std::max(a, b))];
    kept.cells.insert(kept.cells.end(), gone.cells.begin(), gone.cells.end());
    kept.below.insert(kept.below.end(), gone.below.begin(), gone.below.end());
    kept.above.insert(kept.above.end(), gone.above.begin(), gone.above.end());
  }

  Sets sets_;
  std::vector<PassageNode> nodes_;
};

std::size_t degree(const PassageNode& n) { return n.below.size() + n.above.size(); }

/// The nodes from a dead end up to the first junction, exclusive; empty if it leads to another dead end.
std::vector<int> dead_end(const std::vector<PassageNode>& nodes, int end) {
  std::vector<int> path;
  for (int node = end, before = -1; degree(nodes[static_cast<std::size_t>(node)]) < 3;) {
    path.push_back(node);
    int next = -1;
    const PassageNode& n = nodes[static_cast<std::size_t>(node)];
    for (const auto* side : {&n.below, &n.above})
      for (const int m : *side)
        if (m != before) next = m;
    if (next < 0) return {};
    before = node;
    node = next;
  }
  return path;
}

}  // namespace

std::vector<PassageNode> passage_nodes(const CellIndex& cells, const std::vector<float>& distance,
                                       float band) {
  const auto band_of = [&](std::size_t i) { return static_cast<int>(distance[i] / band); };
  Sets sets(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
    for_each_neighbour(cells, i, 13, [&](std::size_t j) {
      if (band_of(i) == band_of(j)) sets.unite(static_cast<int>(i), static_cast<int>(j));
    });
  std::vector<int> roots;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (sets.of(static_cast<int>(i)) == static_cast<int>(i)) roots.push_back(static_cast<int>(i));
  std::stable_sort(roots.begin(), roots.end(), [&](int a, int b) {
    return band_of(static_cast<std::size_t>(a)) < band_of(static_cast<std::size_t>(b));
  });
  std::vector<int> node_of(cells.size());
  std::vector<PassageNode> nodes(roots.size());
  for (std::size_t n = 0; n < roots.size(); ++n) {
    node_of[static_cast<std::size_t>(roots[n])] = static_cast<int>(n);
    nodes[n].band = band_of(static_cast<std::size_t>(roots[n]));
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    node_of[i] = node_of[static_cast<std::size_t>(sets.of(static_cast<int>(i)))];
    nodes[static_cast<std::size_t>(node_of[i])].cells.push_back(static_cast<std::int32_t>(i));
  }
  for (std::size_t i = 0; i < cells.size(); ++i)
    for_each_neighbour(cells, i, 13, [&](std::size_t j) {
      const int a = node_of[i], b = node_of[j];
      if (a == b) return;
      nodes[static_cast<std::size_t>(std::min(a, b))].above.push_back(std::max(a, b));
      nodes[static_cast<std::size_t>(std::max(a, b))].below.push_back(std::min(a, b));
    });
  for (PassageNode& n : nodes) {
    sort_unique(n.below);
    sort_unique(n.above);
  }
  return nodes;
}

std::vector<PassageNode> without_short_loops(const std::vector<PassageNode>& nodes, int least) {
  Uniting graph(nodes);
  for (int u = 0; u < static_cast<int>(nodes.size()); ++u) {
    std::vector<int> kept;
    for (const int b : graph.below(u)) {
      // The shortest loop through this node, b and one of the kept nodes.
      std::vector<int> shortest;
      int lowest = -1;
      for (const int a : kept) {
        std::vector<int> path = graph.highest_path(a, b, nodes[static_cast<std::size_t>(u)].band);
        if (graph.lowest_band(path) > lowest) {
          lowest = graph.lowest_band(path);
          shortest = std::move(path);
        }
      }
      if (!shortest.empty() && nodes[static_cast<std::size_t>(u)].band - lowest < least)
        graph.fold(shortest);
      else
        kept.push_back(b);
    }
  }
  return graph.result();
}

std::vector<PassageNode> without_short_ends(const std::vector<PassageNode>& nodes, int least) {
  std::vector<PassageNode> kept = nodes;
  std::vector<bool> gone(kept.size());
  for (;;) {
    std::vector<int> shortest;
    for (int i = 0; i < static_cast<int>(kept.size()); ++i) {
      if (gone[static_cast<std::size_t>(i)] || degree(kept[static_cast<std::size_t>(i)]) != 1) continue;
      std::vector<int> path = dead_end(kept, i);
      if (!path.empty() && (shortest.empty() || path.size() < shortest.size())) shortest = std::move(path);
    }
    if (shortest.empty() || static_cast<int>(shortest.size()) >= least) break;
    for (const int i : shortest) {
      gone[static_cast<std::size_t>(i)] = true;
      PassageNode& n = kept[static_cast<std::size_t>(i)];
      for (const int m : n.below) std::erase(kept[static_cast<std::size_t>(m)].above, i);
      for (const int m : n.above) std::erase(kept[static_cast<std::size_t>(m)].below, i);
    }
  }
  std::vector<int> number(kept.size(), -1);
  std::vector<PassageNode> out;
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (!gone[i]) {
      number[i] = static_cast<int>(out.size());
      out.push_back(kept[i]);
    }
  for (PassageNode& n : out)
    for (auto* side : {&n.below, &n.above})
      for (int& m : *side) m = number[static_cast<std::size_t>(m)];
  return out;
}

int junctions(std::span<const PassageNode> nodes) {
  int n = 0;
  for (const PassageNode& p : nodes) n += std::max(0, static_cast<int>(degree(p)) - 2);
  return n;
}

int dead_ends(std::span<const PassageNode> nodes) {
  return static_cast<int>(
      std::count_if(nodes.begin(), nodes.end(), [](const PassageNode& p) { return degree(p) < 2; }));
}

int loops(std::span<const PassageNode> nodes) {
  int edges = 0;
  for (const PassageNode& p : nodes) edges += static_cast<int>(p.below.size());
  return edges - static_cast<int>(nodes.size()) + 1;
}

}  // namespace karst::selection
