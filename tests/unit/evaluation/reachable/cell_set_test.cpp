#include "sdk/evaluation/reachable/cell_set.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <set>

#include "core_stack/common/random.h"

namespace {

using namespace karst::evaluation;

std::set<CellKey> random_cells(std::uint64_t seed, double density, const CellKey& low, const CellKey& high) {
  karst::core::Random random(seed);
  std::set<CellKey> cells;
  for (CellKey k = low; k.z <= high.z; ++k.z)
    for (k.y = low.y; k.y <= high.y; ++k.y)
      for (k.x = low.x; k.x <= high.x; ++k.x)
        if (random.uniform() < density) cells.insert(k);
  return cells;
}

TEST(CellSet, HoldsWhatWasPutIn) {
  const CellKey low{-13, -3, -20}, high{5, 14, 2};
  const auto cells = random_cells(3, 0.3, low, high);
  CellSet set(low, high);
  for (const CellKey& k : cells) set.insert(k);
  EXPECT_EQ(set.size(), cells.size());
  std::set<CellKey> visited;
  set.for_each([&](const CellKey& k) { EXPECT_TRUE(visited.insert(k).second); });
  EXPECT_EQ(visited, cells);
  EXPECT_FALSE(set.contains({1000, 0, 0}));
  EXPECT_FALSE(set.contains({-1000, 0, 0}));
}

RC_GTEST_PROP(Flood, AgreesWithCellByCellSearch, ()) {
  // Near the density at which open space falls apart, winding ways are the rule.
  const double density = *rc::gen::inRange(30, 70) * 0.01;
  const CellKey low{-9, -5, -7}, high{10, 11, 9};
  const auto cells = random_cells(*rc::gen::arbitrary<std::uint64_t>(), density, low, high);
  RC_PRE(!cells.empty());
  CellSet set(low, high);
  for (const CellKey& k : cells) set.insert(k);
  const CellKey seed = *cells.begin();
  std::set<CellKey> oracle{seed};
  std::vector<CellKey> queue{seed};
  while (!queue.empty()) {
    const CellKey k = queue.back();
    queue.pop_back();
    for (const CellKey& step : {CellKey{1, 0, 0}, CellKey{-1, 0, 0}, CellKey{0, 1, 0}, CellKey{0, -1, 0},
                                CellKey{0, 0, 1}, CellKey{0, 0, -1}})
      if (cells.count(k + step) && oracle.insert(k + step).second) queue.push_back(k + step);
  }
  const CellSet filled = flood(set, seed);
  RC_ASSERT(filled.size() == oracle.size());
  for (const CellKey& k : oracle) RC_ASSERT(filled.contains(k));
}

TEST(Flood, TellsWhenAComplementLeadsOut) {
  const CellKey low{-24, -24, -24}, high{24, 24, 24};
  CellSet shell(low, high);
  for (CellKey k{-6, -6, -6}; k.z <= 6; ++k.z)
    for (k.y = -6; k.y <= 6; ++k.y)
      for (k.x = -6; k.x <= 6; ++k.x)
        if (std::max({std::abs(k.x), std::abs(k.y), std::abs(k.z)}) == 6) shell.insert(k);
  const std::optional<CellSet> inside = flood_between(shell, {0, 0, 0});
  ASSERT_TRUE(inside);
  EXPECT_EQ(inside->size(), 11u * 11 * 11);
  EXPECT_FALSE(flood_between(shell, {0, 0, 10}));
}

}  // namespace
