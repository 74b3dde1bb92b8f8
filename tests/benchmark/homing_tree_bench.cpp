// The homing tree at 10,000 nodes: five robots' poses in 20 km of winding passages, rays judged in closed
// form, against the same tree computed from scratch by Dijkstra's algorithm with a heap. Times are processor
// times.
#include <cstdio>
#include <map>
#include <queue>

#include "core_stack/homing/path_home/homing_tree.h"
#include "tests/benchmark/times.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

using bench::cpu_ms;
using testing::noise;

constexpr double kCruise = 1.6;
constexpr std::uint32_t kNodes = 10000;

/// Rays see along a passage and are lost round its bends: free if both ends lie within 2 m of the straight
/// line between what is `straight` along the passage. A stand-in for a map, so that it is the tree that is
/// timed.
struct Passages {
  std::vector<Vec3> poses;

  explicit Passages(std::uint64_t seed) {
    Random random(seed);
    std::vector<Vec3> line{Vec3::Zero()};
    while (line.size() < kNodes) {
      // A side passage begins anywhere on what is there.
      Vec3 p = line[random.bits() % line.size()];
      const double heading = random.uniform(0, 6.28), first = static_cast<double>(line.size());
      for (int i = 0; i < 400 && line.size() < kNodes; ++i) {
        const double turn = heading + 1.2 * noise({first + i, 0, 0}, 12, seed),
                     climb = 0.3 * noise({first + i, 9, 0}, 15, seed + 1);
        p += 2.05 * Vec3(std::cos(turn) * std::cos(climb), std::sin(turn) * std::cos(climb), std::sin(climb));
        line.push_back(p);
      }
    }
    poses = line;
  }
  /// Bends block: a third of the rays of more than 6 m, always the same.
  static bool free(const Vec3& a, const Vec3& b) {
    if ((a - b).norm() < 6) return true;
    const Vec3 mid = 0.5 * (a + b);
    return noise(mid, 4, 77) > -0.3;
  }
};

struct FromScratch {
  std::vector<std::vector<std::pair<std::uint32_t, double>>> edges;
  std::vector<char> source;
  std::vector<double> cost;
  void run() {
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    cost.assign(edges.size(), ShortestPaths::unreachable);
    for (std::uint32_t i = 0; i < edges.size(); ++i)
      if (source[i]) cost[i] = 0, open.push({0, i});
    while (!open.empty()) {
      const auto [c, i] = open.top();
      open.pop();
      if (c > cost[i]) continue;
      for (const auto& [k, l] : edges[i])
        if (c + l < cost[k]) cost[k] = c + l, open.push({cost[k], k});
    }
  }
};

void run() {
  const Passages cave(5);
  const FreeRay rays = [](const Vec3& a, const Vec3& b) { return Passages::free(a, b); };
  HomingTree tree({.min_edge_m = 2.0}, kCruise);
  std::map<NodeId, std::uint32_t> index;
  FromScratch scratch;
  const auto mirror = [&](const TreeFacts& facts) {
    for (const TreeNode& n : facts.nodes) {
      index.emplace(n.id, static_cast<std::uint32_t>(scratch.edges.size()));
      scratch.edges.emplace_back();
      scratch.source.push_back(n.kind == NodeKind::communication);
    }
  };
  std::map<NodeId, Vec3> place;
  const auto mirror_rays = [&](const TreeFacts& facts) {
    for (const TreeNode& n : facts.nodes) place[n.id] = n.position;
    for (const RayFact& r : facts.rays) {
      const double c = std::max((place[r.a] - place[r.b]).norm(), 0.01) / kCruise;
      scratch.edges[index[r.a]].push_back({index[r.b], c});
      scratch.edges[index[r.b]].push_back({index[r.a], c});
    }
  };
  bench::Times pose, query, from_scratch, death, birth;
  std::size_t asked = 0;
  const FreeRay counted = [&](const Vec3& a, const Vec3& b) { return ++asked, rays(a, b); };
  const auto base = tree.insert_communication({0, 0}, cave.poses[0], 0, rays);
  mirror(base), mirror_rays(base);
  std::uint32_t number = 0;
  for (const Vec3& p : cave.poses) {
    TreeFacts facts;
    const NodeId id{static_cast<RobotId>(1 + number % 5), number};
    ++number;
    pose.ms.push_back(1e3 * cpu_ms([&] { facts = tree.insert_pose(id, p, 0, counted); }));
    mirror(facts), mirror_rays(facts);
    if (number % 500 == 0) from_scratch.ms.push_back(1e3 * cpu_ms([&] { scratch.run(); }));
  }
  std::size_t edges = 0;
  for (const auto& e : scratch.edges) edges += e.size();
  std::printf("%zu nodes, %zu free rays, %.1f asked an insertion\n", tree.node_count(), edges / 2,
              static_cast<double>(asked) / kNodes);
  // Relays: the deepest pose that is reached becomes one, dies, lives again.
  const auto worst = [&] {
    double most = 0;
    for (const auto& [id, i] : index) {
      const double d = std::abs(tree.cost_s(id) - scratch.cost[i]);
      if (!(tree.cost_s(id) == scratch.cost[i])) most = std::max(most, d);
    }
    return most;
  };
  scratch.run();
  std::printf("largest difference of a cost from the one from scratch: %g s\n", worst());
  Random random(9);
  std::vector<NodeId> relays;
  for (int i = 0; i < 40; ++i) {
    TreeFacts facts;
    const NodeId id{9, static_cast<std::uint32_t>(i)};
    const Vec3 p = cave.poses[random.bits() % cave.poses.size()] + Vec3(0.5, 0.5, 0);
    birth.ms.push_back(1e3 * cpu_ms([&] { facts = tree.insert_communication(id, p, 0, rays); }));
    mirror(facts), mirror_rays(facts);
    relays.push_back(id);
  }
  for (const NodeId& id : relays) {
    death.ms.push_back(1e3 * cpu_ms([&] { tree.set_alive(id, false, kSecond); }));
    scratch.source[index[id]] = false;
    if (random.uniform() < 0.5) tree.set_alive(id, true, 2 * kSecond), scratch.source[index[id]] = true;
  }
  for (int i = 0; i < 20; ++i) from_scratch.ms.push_back(1e3 * cpu_ms([&] { scratch.run(); }));
  std::printf("the same after 40 relays came and half of them went: %g s\n", worst());
  double longest = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 from = cave.poses[random.bits() % cave.poses.size()] + Vec3(0.3, 0.2, 0.1);
    query.ms.push_back(1e3 * cpu_ms([&] {
                         if (const auto route = tree.route(from, rays))
                           longest = std::max(longest, route->length_m);
                       }));
  }
  const auto print = [](const char* what, bench::Times& t) {
    std::printf("  %-40s mean %9.1f  p50 %9.0f  p99 %9.0f  max %9.0f us  (%zu)\n", what, t.mean(), t.at(0.5),
                t.at(0.99), t.at(1.0), t.ms.size());
  };
  print("insert a pose (rays asked for included)", pose);
  print("homing route", query);
  print("a relay lands", birth);
  print("a relay is lost", death);
  print("all costs from scratch (Dijkstra, heap)", from_scratch);
  std::printf("  from scratch at 10,000 nodes over an insertion: %.0f; routes up to %.0f m\n",
              from_scratch.at(1.0) / pose.mean(), longest);
}

}  // namespace
}  // namespace karst::core

int main() { karst::core::run(); }
