// Dynamic shortest paths: the minimal cost from every node of a graph to the nearest of several sources,
// updated incrementally as the graph changes.
//
// Edges and sources may be added and removed. Nodes that become more expensive are invalidated and relaxed
// again from neighbours that still have a path; nodes that become cheaper propagate, cheapest first
// (Ramalingam and Reps, An Incremental Algorithm for a Generalization of the Shortest-Path Problem, 1996).
// The work is proportional to the number of nodes whose cost changes. Costs are bitwise equal to those of
// Dijkstra's algorithm from scratch, and so are the paths: among equal costs the node with the smallest name
// wins. Both therefore depend on the graph only, not on the order of its changes.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

namespace karst::core {

class ShortestPaths {
 public:
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  static constexpr double unreachable = std::numeric_limits<double>::infinity();

  /// Adds a node with a unique `name`; returns its index, one more than the last.
  std::uint32_t add(std::uint64_t name);
  /// Joins two nodes in both directions; they must not be joined yet. `cost` must be finite, and large enough
  /// not to be lost to rounding when added to a path's cost; otherwise paths could contain cycles.
  void join(std::uint32_t a, std::uint32_t b, double cost);
  void part(std::uint32_t a, std::uint32_t b);
  void set_source(std::uint32_t n, bool source);
  /// Recomputes the costs. Call it after changes and before queries.
  void relax();

  std::size_t size() const { return nodes_.size(); }
  /// Cost of the cheapest path from n to a source.
  double cost(std::uint32_t n) const { return nodes_[n].cost; }
  /// The next node on that path; none for a source, or if there is no path.
  std::uint32_t next(std::uint32_t n) const { return nodes_[n].next; }
  bool is_source(std::uint32_t n) const { return nodes_[n].source; }

  struct Edge {
    std::uint32_t to;
    double cost;
  };
  const std::vector<Edge>& edges(std::uint32_t n) const { return nodes_[n].edges; }
  /// Number of nodes that the last relax() visited: its cost.
  std::size_t touched() const { return touched_; }

 private:
  struct Node {
    std::uint64_t name = 0;
    std::vector<Edge> edges;
    double cost = unreachable;
    std::uint32_t next = none;
    bool source = false;
  };
  struct Entry {
    double cost;
    std::uint32_t node;
  };

  void forget(std::uint32_t n);
  void offer(std::uint32_t n, double cost, std::uint32_t by);
  bool comes_before(std::uint32_t a, std::uint32_t b) const;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> lost_;                              // without a path until relaxed
  std::vector<std::pair<std::uint32_t, std::uint32_t>> joined_;  // edges not yet relaxed
  std::vector<Entry> heap_;
  std::size_t touched_ = 0;
};

}  // namespace karst::core
