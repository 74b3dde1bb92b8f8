#include "core_stack/team/communication/relay_graph.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>

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

std::vector<std::vector<double>> random_table(Random& random, std::size_t n, double fraction) {
  std::vector<std::vector<double>> q(n, std::vector<double>(n));
  for (auto& row : q)
    for (double& v : row) v = random.uniform() < fraction ? random.uniform(0.05, 1) : 0;
  return q;
}

RelayGraph::Robots all_robots() {
  RelayGraph::Robots all;
  all.fill(true);
  return all;
}

/// Paths over relays tried one by one, no robot twice: slow and certain.
void walk(const std::vector<std::vector<double>>& q, const RelayGraph::Robots& relays, RobotId at,
          std::vector<RobotId>& path, bool& arrived) {
  arrived = arrived || at == kBase;
  path.push_back(at);
  for (RobotId to = 0; to < q.size() && !arrived; ++to)
    if (std::min(q[at][to], q[to][at]) >= 0.1 && (to == kBase || relays[to]) &&
        std::find(path.begin(), path.end(), to) == path.end())
      walk(q, relays, to, path, arrived);
  path.pop_back();
}

TEST(RelayGraph, AgreesWithAllPathsTriedOneByOne) {
  rc::check("graphs", [] {
    Random random(*rc::gen::inRange<std::uint64_t>(1, 1u << 30));
    const std::size_t n = 2 + random.bits() % 5;
    const auto q = random_table(random, n, 0.6);
    const RelayGraph g = graph_of(q);
    RelayGraph::Robots relays{};
    for (RobotId r = 1; r < n; ++r) relays[r] = random.uniform() < 0.6;
    for (RobotId r = 1; r < n; ++r) {
      bool any_path = false, over_relays = false;
      std::vector<RobotId> path;
      walk(q, all_robots(), r, path, any_path);
      walk(q, relays, r, path, over_relays);
      const std::vector<RobotId> connected = g.connected(0);
      RC_ASSERT((std::find(connected.begin(), connected.end(), r) != connected.end()) == any_path);
      RC_ASSERT(g.reaches_base(0, r, relays) == over_relays);
    }
  });
}

TEST(RelayGraph, AChainLosesAllBehindABrokenLinkAndARingNothing) {
  std::vector<std::vector<double>> q(5, std::vector<double>(5));
  for (std::size_t i = 0; i + 1 < 5; ++i) q[i][i + 1] = q[i + 1][i] = 0.9;
  const std::vector<RobotId> all{0, 1, 2, 3, 4};
  EXPECT_EQ(graph_of(q).connected(0), all);
  q[1][2] = 0;
  EXPECT_EQ(graph_of(q).connected(0), (std::vector<RobotId>{0, 1}));
  q[0][4] = q[4][0] = 0.2;
  EXPECT_EQ(graph_of(q).connected(0), all);
}

TEST(RelayGraph, ALinkHeardOneWayOnlyIsNone) {
  EXPECT_FALSE(graph_of({{0, 0.9}, {0, 0}}).reaches_base(0, 1, all_robots()));
  EXPECT_TRUE(graph_of({{0, 0.9}, {0.9, 0}}).reaches_base(0, 1, all_robots()));
}

TEST(RelayGraph, OldNewsFadesAndNeverOverrulesNewer) {
  RelayGraph g = graph_of({{0, 0.9}, {0.9, 0}}, 10 * kSecond);
  EXPECT_TRUE(g.reaches_base(25 * kSecond, 1, all_robots()));
  EXPECT_FALSE(g.reaches_base(26 * kSecond, 1, all_robots()));
  TeamState old;
  old.robot = 1, old.stamp = 9 * kSecond;  // heard nobody then
  g.note(old);
  EXPECT_TRUE(g.reaches_base(20 * kSecond, 1, all_robots()));
  old.stamp = 11 * kSecond;
  g.note(old);
  EXPECT_FALSE(g.reaches_base(20 * kSecond, 1, all_robots()));
  EXPECT_EQ(g.last_heard_of(1), 11 * kSecond);
}

}  // namespace
}  // namespace karst::core
