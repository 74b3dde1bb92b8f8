#include "core_stack/homing/path_home/shortest_paths.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <map>
#include <set>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

using Edges = std::map<std::pair<std::uint32_t, std::uint32_t>, double>;  // a < b

/// Bellman and Ford: relax every edge until nothing changes.
std::vector<double> costs_from_scratch(std::size_t n, const Edges& edges,
                                       const std::set<std::uint32_t>& sources) {
  std::vector<double> cost(n, ShortestPaths::unreachable);
  for (const std::uint32_t s : sources) cost[s] = 0;
  for (bool again = true; again;) {
    again = false;
    for (const auto& [ab, c] : edges)
      for (const auto& [a, b] : {ab, std::pair{ab.second, ab.first}})
        if (cost[a] + c < cost[b]) cost[b] = cost[a] + c, again = true;
  }
  return cost;
}

TEST(ShortestPaths, AfterAnyChangesCostsAndWaysAreThoseFromScratch) {
  rc::check("random changes", [] {
    Random random(*rc::gen::inRange<std::uint64_t>(1, 1u << 30));
    const auto below = [&random](std::uint32_t n) { return static_cast<std::uint32_t>(random.bits() % n); };
    const std::uint32_t n = 2 + below(14);
    ShortestPaths paths;
    // Names in another order than indices; costs from few values, so that many ways are equally cheap.
    for (std::uint32_t i = 0; i < n; ++i) paths.add((i * 7919u) % 101u);
    Edges edges;
    std::set<std::uint32_t> sources;
    for (int step = 0; step < 40; ++step) {
      for (int k = 1 + static_cast<int>(random.bits() % 4); k > 0; --k) {
        std::uint32_t a = below(n), b = below(n);
        if (random.uniform() < 0.2) {
          const bool source = random.uniform() < 0.5;
          paths.set_source(a, source);
          source ? (void)sources.insert(a) : (void)sources.erase(a);
        } else if (a != b) {
          if (a > b) std::swap(a, b);
          if (edges.erase({a, b}) > 0) {
            paths.part(a, b);
          } else {
            const double cost = 0.1 * static_cast<double>(1 + random.bits() % 3);
            paths.join(a, b, cost);
            edges[{a, b}] = cost;
          }
        }
      }
      paths.relax();
      const std::vector<double> expected = costs_from_scratch(n, edges, sources);
      for (std::uint32_t i = 0; i < n; ++i) {
        RC_ASSERT(paths.cost(i) == expected[i]);
        // The next node is the one of the least name among those that offer the cost.
        std::uint32_t next = ShortestPaths::none;
        if (!sources.contains(i) && expected[i] < ShortestPaths::unreachable)
          for (const auto& [ab, c] : edges)
            for (const auto& [from, to] : {ab, std::pair{ab.second, ab.first}})
              if (from == i && expected[to] + c == expected[i] &&
                  (next == ShortestPaths::none || (to * 7919u) % 101u < (next * 7919u) % 101u))
                next = to;
        RC_ASSERT(paths.next(i) == next);
      }
    }
  });
}

TEST(ShortestPaths, AChangeTouchesOnlyWhatItChanges) {
  ShortestPaths paths;
  constexpr std::uint32_t n = 1000;
  for (std::uint32_t i = 0; i < n; ++i) paths.add(i);
  for (std::uint32_t i = 0; i + 1 < n; ++i) paths.join(i, i + 1, 1);
  paths.set_source(0, true);
  paths.relax();
  EXPECT_EQ(paths.cost(n - 1), n - 1);
  paths.part(n - 2, n - 1);
  paths.relax();
  EXPECT_EQ(paths.touched(), 1u);
  EXPECT_EQ(paths.cost(n - 1), ShortestPaths::unreachable);
  paths.join(n - 3, n - 1, 1.5);
  paths.relax();
  EXPECT_EQ(paths.touched(), 1u);
  EXPECT_EQ(paths.cost(n - 1), n - 3 + 1.5);
}

}  // namespace
}  // namespace karst::core
