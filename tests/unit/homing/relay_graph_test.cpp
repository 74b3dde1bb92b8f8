#include "core_stack/homing/relay_graph.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <functional>
#include <set>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

/// Notes for each of n robots whom it hears, by a table of qualities.
RelayGraph graph_of(const std::vector<std::vector<double>>& quality, TimeNs stamp = 0) {
  RelayGraph g({});
  for (RobotId i = 0; i < quality.size(); ++i) {
    TeamState s;
    s.robot = i, s.stamp = stamp;
    for (RobotId k = 0; k < quality.size(); ++k)
      if (k != i && quality[i][k] > 0) s.heard.push_back({k, quality[i][k]});
    g.note(s);
  }
  return g;
}

std::vector<std::vector<double>> random_table(Random& random, std::size_t n, double share) {
  std::vector<std::vector<double>> q(n, std::vector<double>(n));
  for (auto& row : q)
    for (double& v : row) v = random.uniform() < share ? random.uniform(0.05, 1) : 0;
  return q;
}

/// Paths tried one by one, no robot twice: slow and certain.
void walk(const std::vector<std::vector<double>>& q, RobotId at, std::vector<RobotId>& path,
          const std::function<void(const std::vector<RobotId>&)>& arrived) {
  path.push_back(at);
  if (at == kBase) {
    arrived(path);
  } else {
    for (RobotId to = 0; to < q.size(); ++to)
      if (std::min(q[at][to], q[to][at]) >= 0.1 && std::find(path.begin(), path.end(), to) == path.end())
        walk(q, to, path, arrived);
  }
  path.pop_back();
}

TEST(RelayGraph, AgreesWithAllPathsTriedOneByOne) {
  rc::check("graphs", [] {
    Random random(*rc::gen::inRange<std::uint64_t>(1, 1u << 30));
    const std::size_t n = 2 + random.bits() % 5;
    const auto q = random_table(random, n, 0.6);
    const RelayGraph g = graph_of(q);
    for (RobotId r = 1; r < n; ++r) {
      double least = 1e300;
      std::vector<std::set<RobotId>> on_way;  // what each path needs
      std::set<RobotId> first_hops;
      std::vector<RobotId> path;
      walk(q, r, path, [&](const std::vector<RobotId>& p) {
        double cost = 0;
        for (std::size_t i = 0; i + 1 < p.size(); ++i) cost += 1 / (q[p[i]][p[i + 1]] * q[p[i + 1]][p[i]]);
        if (cost < least - 1e-9) least = cost, first_hops = {p[1]};
        on_way.push_back({p.begin(), p.end()});
      });
      RC_ASSERT(g.reaches_base(0, r) == !on_way.empty());
      RC_ASSERT(g.next_hop(0, r).has_value() == !on_way.empty());
      if (!on_way.empty()) RC_ASSERT(first_hops.contains(*g.next_hop(0, r)));
      for (RobotId relay = 1; relay < n; ++relay) {
        if (relay == r) continue;
        const bool needed = !on_way.empty() && std::all_of(on_way.begin(), on_way.end(),
                                                           [&](const auto& p) { return p.contains(relay); });
        const auto lost = g.lost_without(0, relay);
        RC_ASSERT((std::find(lost.begin(), lost.end(), r) != lost.end()) == needed);
        if (needed) {
          const auto all = g.indispensable(0);
          RC_ASSERT(std::find(all.begin(), all.end(), relay) != all.end());
        }
      }
      // One more, that hears what r hears and r itself: it survives if no single robot is on all its ways.
      std::vector<RobotId> neighbours;
      for (RobotId k = 0; k < n; ++k)
        if (random.uniform() < 0.5) neighbours.push_back(k);
      std::vector<std::set<RobotId>> ways;
      for (const RobotId k : neighbours)
        walk(q, k, path, [&](const std::vector<RobotId>& p) { ways.push_back({p.begin(), p.end()}); });
      bool survives = !ways.empty();
      for (RobotId relay = 1; relay < n; ++relay)
        survives = survives &&
                   !std::all_of(ways.begin(), ways.end(), [&](const auto& p) { return p.contains(relay); });
      RC_ASSERT(g.survives_any_loss(0, neighbours) == survives);
    }
  });
}

TEST(RelayGraph, AChainLosesAllBehindABrokenLinkAndARingNothing) {
  std::vector<std::vector<double>> q(5, std::vector<double>(5));
  for (std::size_t i = 0; i + 1 < 5; ++i) q[i][i + 1] = q[i + 1][i] = 0.9;
  EXPECT_EQ(graph_of(q).lost_without(0, 2), (std::vector<RobotId>{3, 4}));
  EXPECT_EQ(graph_of(q).indispensable(0), (std::vector<RobotId>{1, 2, 3}));
  EXPECT_FALSE(graph_of(q).survives_any_loss(0, {4, 3}));
  EXPECT_TRUE(graph_of(q).survives_any_loss(0, {0}));
  q[0][4] = q[4][0] = 0.2;
  EXPECT_TRUE(graph_of(q).indispensable(0).empty());
  EXPECT_TRUE(graph_of(q).survives_any_loss(0, {4, 3}));
  EXPECT_EQ(graph_of(q).next_hop(0, 4), RobotId{3});  // four good links before one bad
}

TEST(RelayGraph, ALinkHeardOneWayOnlyIsNone) {
  EXPECT_FALSE(graph_of({{0, 0.9}, {0, 0}}).reaches_base(0, 1));
  EXPECT_TRUE(graph_of({{0, 0.9}, {0.9, 0}}).reaches_base(0, 1));
}

TEST(RelayGraph, OldNewsFadesAndNeverOverrulesNewer) {
  RelayGraph g = graph_of({{0, 0.9}, {0.9, 0}}, 10 * kSecond);
  EXPECT_TRUE(g.reaches_base(25 * kSecond, 1));
  EXPECT_FALSE(g.reaches_base(26 * kSecond, 1));
  TeamState old;
  old.robot = 1, old.stamp = 9 * kSecond;  // heard nobody then
  g.note(old);
  EXPECT_TRUE(g.reaches_base(20 * kSecond, 1));
  old.stamp = 11 * kSecond;
  g.note(old);
  EXPECT_FALSE(g.reaches_base(20 * kSecond, 1));
  EXPECT_EQ(g.last_heard_of(1), 11 * kSecond);
}

}  // namespace
}  // namespace karst::core
