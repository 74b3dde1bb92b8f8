// Least costs from every node of a graph to the nearest of several sources, kept as the graph changes.
//
// Edges may come and go, sources too. What a change makes dearer is forgotten and settled anew from the
// neighbours that still know a way; what it makes cheaper is passed on, cheapest first (Ramalingam and Reps,
// An Incremental Algorithm for a Generalization of the Shortest-Path Problem, 1996). A change costs as much
// as there are nodes whose cost it changes. Costs are the same bits as Dijkstra's algorithm gives from
// scratch, and so are the ways: of equally cheap ones the node of the least name is kept. So both depend on
// the graph only, not on the order in which it came about.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

namespace karst::core {

class ShortestPaths {
 public:
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  static constexpr double unreachable = std::numeric_limits<double>::infinity();

  /// A new node with an own `name`; returns its index, one more than the last.
  std::uint32_t add(std::uint64_t name);
  /// Joins two nodes both ways; they must not be joined yet. `cost` is finite and large enough to be felt
  /// when added to a way's cost, or ways could run in circles.
  void join(std::uint32_t a, std::uint32_t b, double cost);
  void part(std::uint32_t a, std::uint32_t b);
  void set_source(std::uint32_t n, bool source);
  /// To be called after changes, before anything is asked.
  void relax();

  std::size_t size() const { return nodes_.size(); }
  /// Cost of the cheapest way from n to a source.
  double cost(std::uint32_t n) const { return nodes_[n].cost; }
  /// The next node on that way; none for a source, or if there is no way.
  std::uint32_t next(std::uint32_t n) const { return nodes_[n].next; }
  bool is_source(std::uint32_t n) const { return nodes_[n].source; }

  struct Edge {
    std::uint32_t to;
    double cost;
  };
  const std::vector<Edge>& edges(std::uint32_t n) const { return nodes_[n].edges; }
  /// Nodes that the last settle() took up: what it cost.
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
  std::vector<std::uint32_t> lost_;                              // know no way until settled
  std::vector<std::pair<std::uint32_t, std::uint32_t>> joined_;  // edges not yet looked at
  std::vector<Entry> heap_;
  std::size_t touched_ = 0;
};

}  // namespace karst::core
