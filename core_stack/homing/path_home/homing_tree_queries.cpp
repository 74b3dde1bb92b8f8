// Queries of the homing tree.
#include <algorithm>

#include "core_stack/homing/path_home/homing_tree.h"

namespace karst::core {

std::optional<HomingRoute> HomingTree::route(const Vec3& from, const FreeRay& free_ray) const {
  struct Start {
    double time_s;
    std::uint32_t node;
  };
  std::vector<Start> starts;
  grid_.for_each_within(from, options_.longest_edge_m, [&](std::uint32_t i, const Vec3& p) {
    const double cost_s = paths_.cost(i);
    if (cost_s < ShortestPaths::unreachable) starts.push_back({(p - from).norm() / cruise_mps_ + cost_s, i});
  });
  std::sort(starts.begin(), starts.end(), [this](const Start& a, const Start& b) {
    if (a.time_s != b.time_s) return a.time_s < b.time_s;
    return entries_[a.node].node.id < entries_[b.node].node.id;
  });
  // Rays are the most expensive part, and usually the first one is free.
  const auto first = std::find_if(starts.begin(), starts.end(), [&](const Start& s) {
    return free_ray(from, entries_[s.node].node.position);
  });
  if (first == starts.end()) return std::nullopt;
  HomingRoute route;
  route.time_s = first->time_s;
  route.points = {from};
  for (std::uint32_t i = first->node; i != ShortestPaths::none; i = paths_.next(i)) {
    route.length_m += (entries_[i].node.position - route.points.back()).norm();
    route.points.push_back(entries_[i].node.position);
    route.nodes.push_back(entries_[i].node.id);
  }
  return route;
}

double HomingTree::cost_s(const NodeId& id) const {
  const auto i = find(id);
  return i ? paths_.cost(*i) : ShortestPaths::unreachable;
}

std::optional<NodeId> HomingTree::next(const NodeId& id) const {
  const auto i = find(id);
  if (!i || paths_.next(*i) == ShortestPaths::none) return std::nullopt;
  return entries_[paths_.next(*i)].node.id;
}

bool HomingTree::alive(const NodeId& id) const {
  const auto i = find(id);
  return i && paths_.is_source(*i);
}

std::vector<TreeNode> HomingTree::nodes() const { return facts().nodes; }

TreeFacts HomingTree::facts() const {
  TreeFacts out;
  for (const Entry& e : entries_) {
    if (e.known) out.nodes.push_back(e.node);
    if (e.life_stamp >= 0) out.lives.push_back({e.node.id, e.alive, e.life_stamp});
    for (const Ray& r : e.rays)
      if (e.node.id < entries_[r.to].node.id)
        out.rays.push_back({e.node.id, entries_[r.to].node.id, r.free, r.stamp});
  }
  const auto by_id = [](const auto& a, const auto& b) { return a.id < b.id; };
  std::sort(out.nodes.begin(), out.nodes.end(), by_id);
  std::sort(out.lives.begin(), out.lives.end(), by_id);
  std::sort(out.rays.begin(), out.rays.end(),
            [](const RayFact& a, const RayFact& b) { return std::tie(a.a, a.b) < std::tie(b.a, b.b); });
  return out;
}

}  // namespace karst::core
