#include "core_stack/homing/path_home/shortest_paths.h"

#include <algorithm>

namespace karst::core {

std::uint32_t ShortestPaths::add(std::uint64_t name) {
  nodes_.emplace_back().name = name;
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

void ShortestPaths::join(std::uint32_t a, std::uint32_t b, double cost) {
  nodes_[a].edges.push_back({b, cost});
  nodes_[b].edges.push_back({a, cost});
  joined_.push_back({a, b});
}

void ShortestPaths::part(std::uint32_t a, std::uint32_t b) {
  const auto drop = [this](std::uint32_t from, std::uint32_t to) {
    std::erase_if(nodes_[from].edges, [to](const Edge& e) { return e.to == to; });
  };
  // Invalidate paths over this edge before removing it.
  if (nodes_[a].next == b) forget(a);
  if (nodes_[b].next == a) forget(b);
  drop(a, b);
  drop(b, a);
}

void ShortestPaths::set_source(std::uint32_t n, bool source) {
  if (nodes_[n].source == source) return;
  if (!source) forget(n);
  nodes_[n].source = source;
  if (source) lost_.push_back(n);
}

/// Invalidates n and all nodes whose path leads through it.
void ShortestPaths::forget(std::uint32_t n) {
  std::vector<std::uint32_t> open{n};
  while (!open.empty()) {
    const std::uint32_t m = open.back();
    open.pop_back();
    nodes_[m].cost = unreachable;
    nodes_[m].next = none;
    lost_.push_back(m);
    for (const Edge& e : nodes_[m].edges)
      if (nodes_[e.to].next == m) open.push_back(e.to);
  }
}

bool ShortestPaths::comes_before(std::uint32_t a, std::uint32_t b) const {
  return b == none || nodes_[a].name < nodes_[b].name;
}

void ShortestPaths::offer(std::uint32_t n, double cost, std::uint32_t by) {
  Node& node = nodes_[n];
  if (cost == node.cost && by != none && node.next != none && comes_before(by, node.next)) node.next = by;
  if (cost >= node.cost) return;
  node.cost = cost;
  node.next = by;
  heap_.push_back({cost, n});
  std::push_heap(heap_.begin(), heap_.end(), [](const Entry& a, const Entry& b) { return a.cost > b.cost; });
}

void ShortestPaths::relax() {
  touched_ = lost_.size();
  // Collect the offers for all lost nodes first. An offer based on another lost node would be correct, but
  // push entries that become stale.
  std::vector<Entry> offers(lost_.size(), {unreachable, none});  // with the node that offers each
  for (std::size_t i = 0; i < lost_.size(); ++i)
    for (const Edge& e : nodes_[lost_[i]].edges) {
      const double cost = nodes_[e.to].cost + e.cost;
      if (cost < offers[i].cost ||
          (cost == offers[i].cost && cost < unreachable && comes_before(e.to, offers[i].node)))
        offers[i] = {cost, e.to};
    }
  for (std::size_t i = 0; i < lost_.size(); ++i) {
    if (nodes_[lost_[i]].source) offer(lost_[i], 0, none);
    if (offers[i].cost < unreachable) offer(lost_[i], offers[i].cost, offers[i].node);
  }
  for (const auto& [a, b] : joined_)
    for (const Edge& e : nodes_[a].edges)  // the edge may have been removed again
      if (e.to == b) {
        if (nodes_[a].cost < unreachable) offer(b, nodes_[a].cost + e.cost, a);
        if (nodes_[b].cost < unreachable) offer(a, nodes_[b].cost + e.cost, b);
      }
  lost_.clear();
  joined_.clear();

  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), [](const Entry& a, const Entry& b) { return a.cost > b.cost; });
    const Entry top = heap_.back();
    heap_.pop_back();
    if (top.cost != nodes_[top.node].cost) continue;
    ++touched_;
    for (const Edge& e : nodes_[top.node].edges) offer(e.to, top.cost + e.cost, top.node);
  }
}

}  // namespace karst::core
