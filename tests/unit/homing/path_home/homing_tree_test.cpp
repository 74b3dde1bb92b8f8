#include "core_stack/homing/path_home/homing_tree.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <set>

#include "core_stack/homing/path_home/map_rays.h"
#include "core_stack/planning/roadmap/roadmap.h"
#include "tests/unit/homing/path_home/tree_world.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

using testing::BallWorld;

constexpr double kCruise = 1.6;
const FreeRay kAllFree = [](const Vec3&, const Vec3&) { return true; };

/// Ends at its root without coming to a node twice, and gets cheaper with every step.
void expect_paths_end(const HomingTree& tree) {
  for (const TreeNode& n : tree.nodes()) {
    if (tree.cost_s(n.id) == ShortestPaths::unreachable) {
      RC_ASSERT(!tree.next(n.id));
      continue;
    }
    NodeId at = n.id;
    std::size_t steps = 0;
    while (const auto next = tree.next(at)) {
      RC_ASSERT(++steps < tree.node_count());
      RC_ASSERT(tree.cost_s(*next) < tree.cost_s(at));
      at = *next;
    }
    RC_ASSERT(tree.alive(at));
  }
}

TEST(HomingTree, CostsAreTheLeastOverFreeRaysWhateverCameInWhichOrder) {
  rc::check("inserting", [] {
    Random random(*rc::gen::inRange<std::uint64_t>(1, 1u << 30));
    const BallWorld world = BallWorld::random(random, 12, {40, 20, 6});
    HomingTree tree({}, kCruise);
    std::map<NodeId, bool> dead;
    std::uint32_t number = 0;
    for (int i = 0; i < 60; ++i) {
      const double what = random.uniform();
      if (what < 0.08 || i == 5)
        tree.insert_communication({0, number++}, world.place(random), i * kSecond, world.rays());
      else if (what < 0.16 && number > 0) {
        const NodeId id{0, static_cast<std::uint32_t>(random.bits() % number)};
        const bool dies = !dead.contains(id);
        dies ? (void)(dead[id] = true) : (void)dead.erase(id);
        tree.set_alive(id, !dies, i * kSecond);
      } else
        tree.insert_pose({1, static_cast<std::uint32_t>(i)}, world.place(random), i * kSecond, world.rays());
    }
    const auto expected = testing::costs_from_scratch(tree.nodes(), dead, world.rays(), 15, kCruise);
    for (const auto& [id, cost] : expected) RC_ASSERT(tree.cost_s(id) == cost);
    expect_paths_end(tree);

    // The same nodes in another order: the same costs, to the bit.
    std::vector<TreeNode> nodes = tree.nodes();
    for (std::size_t i = nodes.size(); i > 1; --i) std::swap(nodes[i - 1], nodes[random.bits() % i]);
    HomingTree other({.min_edge_m = 0}, kCruise);
    for (const TreeNode& n : nodes)
      n.kind == NodeKind::pose ? other.insert_pose(n.id, n.position, 0, world.rays())
                               : other.insert_communication(n.id, n.position, 0, world.rays());
    for (const auto& [id, stays_dead] : dead) other.set_alive(id, false, kSecond);
    for (const TreeNode& n : nodes) {
      RC_ASSERT(other.cost_s(n.id) == tree.cost_s(n.id));
      RC_ASSERT(other.next(n.id) == tree.next(n.id));
    }
  });
}

/// Three robots in one world, each with an own map of it, and all they ever said.
TEST(HomingTree, FactsInAnyOrderTwiceAndInPiecesMakeOneTree) {
  rc::check("merging", [] {
    Random random(*rc::gen::inRange<std::uint64_t>(1, 1u << 30));
    const BallWorld world = BallWorld::random(random, 10, {30, 20, 5});
    std::vector<HomingTree> robots(3, HomingTree({}, kCruise));
    std::vector<TreeFacts> said;
    const auto say = [&](const TreeFacts& facts) {
      // In pieces of one fact, as a lossy link may leave them.
      for (const auto& n : facts.nodes) said.push_back({{n}, {}, {}});
      for (const auto& r : facts.rays) said.push_back({{}, {r}, {}});
      for (const auto& l : facts.lives) said.push_back({{}, {}, {l}});
    };
    say(robots[0].insert_communication({0, 0}, world.place(random), 0, kAllFree));
    for (std::uint32_t i = 0; i < 45; ++i) {
      const auto who = static_cast<RobotId>(random.bits() % 3);
      HomingTree& robot = robots[who];
      const TimeNs now = i * kSecond;
      const double what = random.uniform();
      if (what < 0.7) {
        say(robot.insert_pose({who, 100 + i}, world.place(random), now, world.rays()));
      } else if (what < 0.8) {
        say(robot.insert_communication({who, 100 + i}, world.place(random), now, world.rays()));
      } else if (what < 0.9) {
        const Vec3 p = world.place(random);
        const FreeRay fallen = [&](const Vec3& a, const Vec3& b) {
          return world.free(a, b) && (a - p).norm() > 6 && (b - p).norm() > 6;
        };
        const FreeRay rock = [&](const Vec3& a, const Vec3& b) { return !fallen(a, b); };
        say(robot.recheck(p - Vec3::Constant(3), p + Vec3::Constant(3), 0.5, now, fallen, rock));
      } else {
        say(robot.set_alive({0, 0}, random.uniform() < 0.5, now));
      }
      if (!said.empty() && random.uniform() < 0.3)
        robots[random.bits() % 3].apply(said[random.bits() % said.size()]);
    }
    std::vector<HomingTree> merged;
    for (int order = 0; order < 3; ++order) {
      std::vector<TreeFacts> pieces = said;
      for (std::size_t i = 0; i < said.size() / 3; ++i) pieces.push_back(said[random.bits() % said.size()]);
      for (std::size_t i = pieces.size(); i > 1; --i) std::swap(pieces[i - 1], pieces[random.bits() % i]);
      HomingTree tree = order == 0 ? HomingTree({}, kCruise) : robots[static_cast<std::size_t>(order)];
      for (const TreeFacts& f : pieces) RC_ASSERT(tree.apply(f) == 0u);
      expect_paths_end(tree);
      merged.push_back(std::move(tree));
    }
    // Whole states merged give the same as all that was said.
    HomingTree whole = robots[2];
    whole.apply(robots[0].facts());
    whole.apply(robots[1].facts());
    merged.push_back(std::move(whole));
    for (const TreeNode& n : merged[0].nodes())
      for (const HomingTree& tree : merged) {
        RC_ASSERT(tree.cost_s(n.id) == merged[0].cost_s(n.id));
        RC_ASSERT(tree.next(n.id) == merged[0].next(n.id));
        RC_ASSERT(tree.node_count() == merged[0].node_count());
      }
  });
}

TEST(HomingTree, ANewCommunicationNodeTakesOverOnlyWhatItsRaysReach) {
  // A wall at x = 5 with a gap far off: the node behind it is 2 m away and cannot be flown to.
  const FreeRay wall = [](const Vec3& a, const Vec3& b) { return (a.x() < 5) == (b.x() < 5); };
  HomingTree tree({}, kCruise);
  tree.insert_communication({0, 0}, {0, 0, 0}, 0, wall);
  tree.insert_pose({1, 0}, {4, 0, 0}, 0, wall);
  tree.insert_communication({2, 0}, {6, 0, 0}, 0, wall);
  EXPECT_EQ(tree.next({1, 0}), (NodeId{0, 0}));  // as printed, Algorithm 1 would lead through the wall
  EXPECT_DOUBLE_EQ(tree.cost_s({1, 0}), 4 / kCruise);
}

TEST(HomingTree, AShortcutShortensAllThatLiesBehindIt) {
  // Along two sides of a square, then a pose in the middle that sees both ends.
  const FreeRay bend = [](const Vec3& a, const Vec3& b) {
    return (a - b).norm() < 11 && !(std::abs(a.x() - b.x()) > 5 && std::abs(a.y() - b.y()) > 5);
  };
  HomingTree tree({}, 1);
  tree.insert_communication({0, 0}, {0, 0, 0}, 0, bend);
  tree.insert_pose({1, 0}, {10, 0, 0}, 0, bend);
  tree.insert_pose({1, 1}, {10, 10, 0}, 0, bend);
  tree.insert_pose({1, 2}, {10, 18, 0}, 0, bend);
  EXPECT_DOUBLE_EQ(tree.cost_s({1, 2}), 28);
  tree.insert_pose({2, 0}, {5, 5, 0}, 0, bend);
  EXPECT_NEAR(tree.cost_s({1, 1}), 2 * std::sqrt(50), 1e-12);
  EXPECT_NEAR(tree.cost_s({1, 2}), 2 * std::sqrt(50) + 8, 1e-12);
}

TEST(HomingTree, ALostRelayLeavesTheWaysToTheOthers) {
  HomingTree tree({}, 1);
  tree.insert_communication({0, 0}, {0, 0, 0}, 0, kAllFree);
  for (std::uint32_t i = 1; i <= 4; ++i) tree.insert_pose({1, i}, {10.0 * i, 0, 0}, 0, kAllFree);
  tree.insert_communication({2, 0}, {44, 0, 0}, 0, kAllFree);
  EXPECT_DOUBLE_EQ(tree.cost_s({1, 4}), 4);
  tree.set_alive({2, 0}, false, kSecond);
  EXPECT_DOUBLE_EQ(tree.cost_s({1, 4}), 40);
  EXPECT_DOUBLE_EQ(tree.cost_s({2, 0}), 44);  // still a place that can be flown from
  tree.set_alive({0, 0}, false, kSecond);
  EXPECT_EQ(tree.cost_s({1, 4}), ShortestPaths::unreachable);
  EXPECT_FALSE(tree.route({41, 0, 0}, kAllFree));
  tree.set_alive({2, 0}, true, 2 * kSecond);
  EXPECT_DOUBLE_EQ(tree.cost_s({1, 1}), 34);
  // News that is older than what is known changes nothing.
  tree.set_alive({2, 0}, false, kSecond);
  EXPECT_TRUE(tree.alive({2, 0}));
}

TEST(HomingTree, PosesNearerThanTheLeastEdgeAreNotTaken) {
  HomingTree tree({}, kCruise);
  tree.insert_communication({0, 0}, {0, 0, 0}, 0, kAllFree);
  EXPECT_TRUE(tree.insert_pose({1, 0}, {1.9, 0, 0}, 0, kAllFree).empty());
  EXPECT_EQ(tree.insert_pose({1, 0}, {2.0, 0, 0}, 0, kAllFree).rays.size(), 1u);
  EXPECT_TRUE(tree.insert_pose({1, 1}, {2.0, 1.5, 0}, 0, kAllFree).empty());
  EXPECT_EQ(tree.node_count(), 2u);
}

TEST(HomingTree, WhatCannotBeIsRefusedAndCounted) {
  HomingTree tree({.max_nodes = 10}, kCruise);
  const double nan = std::nan("");
  EXPECT_EQ(tree.apply({{{{1, 0}, NodeKind::pose, {nan, 0, 0}}, {{1, 1}, NodeKind::pose, {0, 1e300, 0}}},
                        {{{1, 2}, {1, 2}, true, 0}, {{1, 2}, {1, 3}, true, -5}},
                        {}}),
            4u);
  for (std::uint32_t i = 0; i < 30; ++i)
    tree.apply({{{{1, i}, NodeKind::pose, {3.0 * i, 0, 0}}}, {}, {{{7, i}, true, 0}}});
  EXPECT_LE(tree.facts().nodes.size() + tree.facts().lives.size(), 10u);
}

TEST(HomingTree, InAMapRaysKeepTheClearanceAndARockfallIsFlownAround) {
  // A ring of corridors 2 m wide around a block: 12 by 8 m outside.
  std::vector<CellChange> changes;
  VoxelMap map{MapOptions{}};
  const auto in = [](int v, int low, int high) { return v >= low && v < high; };
  testing::draw(
      map, {-2, -2, -2}, {62, 42, 12},
      [&](const CellKey& k) {
        const bool sides = in(k.y, 0, 40) && (in(k.x, 0, 10) || in(k.x, 50, 60));
        const bool ends = in(k.x, 0, 60) && (in(k.y, 0, 10) || in(k.y, 30, 40));
        return (sides || ends) && in(k.z, 0, 10) ? Cell::free : Cell::occupied;
      },
      &changes);
  Roadmap roadmap{PlanningOptions{}};
  roadmap.update(map, changes);
  const FreeRay rays = free_rays(roadmap, 0.5), rock = rock_rays(map, 0.5);
  HomingTree tree({.min_edge_m = 1}, 1);
  tree.insert_communication({0, 0}, {1, 1, 1}, 0, rays);
  std::uint32_t number = 0;
  for (const Vec3& p :
       {Vec3(4, 1, 1), {8, 1, 1}, {11, 1, 1}, {11, 4, 1}, {11, 7, 1}, {6, 7, 1}, {1, 7, 1}, {1, 4, 1}})
    tree.insert_pose({1, number++}, p, 0, rays);
  const auto straight = tree.route({10.5, 1.2, 1}, rays);
  ASSERT_TRUE(straight);
  EXPECT_NEAR(straight->length_m, 9.5, 0.1);
  // No ray leads through the block.
  for (const RayFact& r : tree.facts().rays) EXPECT_FALSE(r.a == (NodeId{1, 1}) && r.b == (NodeId{1, 5}));

  std::vector<CellChange> fall;
  for (int z = 0; z < 10; ++z)
    for (int y = 0; y < 10; ++y) {
      map.assign({30, y, z}, 1, 2.0f);
      fall.push_back({{30, y, z}, Cell::free, Cell::occupied});
    }
  roadmap.update(map, fall);
  const TreeFacts news =
      tree.recheck(map.center_of({30, 0, 0}), map.center_of({30, 9, 9}), 0.5, kSecond, rays, rock);
  EXPECT_FALSE(news.rays.empty());
  for (const RayFact& r : news.rays) EXPECT_FALSE(r.free);
  const auto around = tree.route({10.5, 1.2, 1}, rays);
  ASSERT_TRUE(around);
  EXPECT_GT(around->length_m, 20);
  for (std::size_t i = 0; i + 1 < around->points.size(); ++i)
    EXPECT_TRUE(roadmap.segment_clear(around->points[i], around->points[i + 1], 0.5));
}

TEST(HomingTree, WhatOthersSawThroughIsNotTakenBackBecauseItIsUnknownHere) {
  VoxelMap map{MapOptions{}};
  map.declare_free({0, 0, 1}, 2);  // all that this robot has seen
  const FreeRay none = [](const Vec3&, const Vec3&) { return false; };
  HomingTree tree({}, kCruise);
  tree.insert_communication({0, 0}, {0, 0, 1}, 0, kAllFree);
  tree.apply({{{{2, 0}, NodeKind::pose, {8, 0, 1}}}, {{{0, 0}, {2, 0}, true, 0}}, {}});
  const Vec3 low(-2, -2, -1), high(2, 2, 3);
  EXPECT_TRUE(tree.recheck(low, high, 0.5, kSecond, none, rock_rays(map, 0.5)).empty());
  EXPECT_LT(tree.cost_s({2, 0}), 10);
  map.assign(map.key_of({4, 0.3, 1}), 1, 2.0f);  // beside the line, nearer than the clearance
  EXPECT_EQ(tree.recheck(low, high, 0.5, kSecond, none, rock_rays(map, 0.5)).rays.size(), 1u);
  EXPECT_EQ(tree.cost_s({2, 0}), ShortestPaths::unreachable);
}

TEST(HomingTree, ARouteIsTheCheapestOfAllFirstRays) {
  rc::check("routes", [] {
    Random random(*rc::gen::inRange<std::uint64_t>(1, 1u << 30));
    const BallWorld world = BallWorld::random(random, 12, {30, 20, 6});
    HomingTree tree({}, kCruise);
    tree.insert_communication({0, 0}, world.place(random), 0, world.rays());
    for (std::uint32_t i = 0; i < 40; ++i) tree.insert_pose({1, i}, world.place(random), 0, world.rays());
    const Vec3 from = world.place(random);
    double best = ShortestPaths::unreachable;
    for (const TreeNode& n : tree.nodes())
      if ((n.position - from).norm() <= 15 && world.free(from, n.position))
        best = std::min(best, (n.position - from).norm() / kCruise + tree.cost_s(n.id));
    const auto route = tree.route(from, world.rays());
    RC_ASSERT(route.has_value() == (best < ShortestPaths::unreachable));
    if (!route) return;
    RC_ASSERT(route->time_s == best);
    RC_ASSERT(std::abs(route->length_m / kCruise - best) < 1e-9);
    RC_ASSERT(route->points.size() == route->nodes.size() + 1);
    for (std::size_t i = 0; i + 1 < route->points.size(); ++i)
      RC_ASSERT(world.free(route->points[i], route->points[i + 1]));
  });
}

}  // namespace
}  // namespace karst::core
