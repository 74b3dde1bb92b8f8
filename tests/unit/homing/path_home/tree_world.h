// A world of balls that block rays, and the homing tree computed from scratch.
#pragma once
#include <map>
#include <vector>

#include "core_stack/common/random.h"
#include "core_stack/homing/path_home/homing_tree.h"

namespace karst::core::testing {

struct BallWorld {
  struct Ball {
    Vec3 centre;
    double radius_m;
  };
  std::vector<Ball> balls;
  Vec3 size;

  static BallWorld random(Random& random, std::size_t count, const Vec3& size) {
    BallWorld world;
    world.size = size;
    for (std::size_t i = 0; i < count; ++i)
      world.balls.push_back({world.place(random), random.uniform(0.5, 2.5)});
    return world;
  }
  Vec3 place(Random& random) const {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    return {x * size.x(), y * size.y(), z * size.z()};
  }
  bool free(const Vec3& a, const Vec3& b) const {
    for (const Ball& ball : balls) {
      const Vec3 d = b - a;
      const double l2 = d.squaredNorm();
      const double t = l2 > 0 ? std::clamp((ball.centre - a).dot(d) / l2, 0.0, 1.0) : 0.0;
      if ((a + t * d - ball.centre).norm() < ball.radius_m) return false;
    }
    return true;
  }
  FreeRay rays() const {
    return [this](const Vec3& a, const Vec3& b) { return free(a, b); };
  }
};

/// Dijkstra's algorithm in its plainest form over all pairs that a world leaves free. A node that is dead or
/// a pose is no source.
inline std::map<NodeId, double> costs_from_scratch(const std::vector<TreeNode>& nodes,
                                                   const std::map<NodeId, bool>& dead, const FreeRay& free,
                                                   double longest_m, double cruise_mps) {
  std::map<NodeId, double> cost;
  for (const TreeNode& n : nodes)
    cost[n.id] = n.kind == NodeKind::communication && !dead.contains(n.id) ? 0 : ShortestPaths::unreachable;
  std::vector<char> done(nodes.size(), 0);
  for (;;) {
    std::size_t best = nodes.size();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (!done[i] && cost[nodes[i].id] < ShortestPaths::unreachable &&
          (best == nodes.size() || cost[nodes[i].id] < cost[nodes[best].id]))
        best = i;
    if (best == nodes.size()) return cost;
    done[best] = 1;
    for (const TreeNode& n : nodes) {
      const double l = (n.position - nodes[best].position).norm();
      if (n.id == nodes[best].id || l > longest_m || !free(n.position, nodes[best].position)) continue;
      cost[n.id] = std::min(cost[n.id], cost[nodes[best].id] + std::max(l, 0.01) / cruise_mps);
    }
  }
}

}  // namespace karst::core::testing
