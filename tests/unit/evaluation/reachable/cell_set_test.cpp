#include "sdk/evaluation/reachable/cell_set.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <tuple>

#include "core_stack/common/random.h"
#include "sdk/evaluation/reachable/open_cave.h"

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

/// Clusters of cells, far from each other, in bounds of 5 km at 0.2 m.
std::set<CellKey> scattered_cells(const CellKey& low, const CellKey& high) {
  karst::core::Random random(11);
  const auto between = [&](std::int32_t a, std::int32_t b) {
    return a + static_cast<std::int32_t>(random.uniform() * (b - a));
  };
  std::set<CellKey> cells{low, high};
  for (int cluster = 0; cluster < 150; ++cluster) {
    const CellKey centre{between(low.x + 20, high.x - 20), between(low.y + 20, high.y - 20),
                         between(low.z + 20, high.z - 20)};
    for (int i = 0; i < 60; ++i)
      cells.insert(centre + CellKey{between(-20, 21), between(-20, 21), between(-20, 21)});
  }
  return cells;
}

TEST(CellSet, CellsFarApartComeByBlockAndTakeNoRoomBetween) {
  const CellKey low{-12500, -12490, -12480}, high{12500, 12510, 12520};
  const auto cells = scattered_cells(low, high);
  CellSet set(low, high);
  EXPECT_EQ(set.tile_count(), 0u);
  for (const CellKey& k : cells) set.insert(k);
  std::vector<CellKey> oracle(cells.begin(), cells.end());
  const auto rank = [](const CellKey& k) {  // arithmetic shift: the same blocks on both sides of 0
    return std::tuple(k.z >> 3, k.y >> 3, k.x >> 3, k.z, k.y, k.x);
  };
  std::sort(oracle.begin(), oracle.end(),
            [&](const CellKey& a, const CellKey& b) { return rank(a) < rank(b); });
  std::vector<CellKey> visited;
  set.for_each([&](const CellKey& k) { visited.push_back(k); });
  EXPECT_EQ(visited, oracle);
  EXPECT_EQ(set.size(), cells.size());

  std::set<CellKey> blocks, tiles;
  for (const CellKey& k : cells) {
    EXPECT_TRUE(set.contains(k));
    blocks.insert(set.block_of(k));
    tiles.insert(CellSet::tile_of(set.block_of(k)));
  }
  EXPECT_EQ(set.block_count(), blocks.size());
  EXPECT_EQ(set.tile_count(), tiles.size());
  std::set<std::int32_t> numbers;
  for (const CellKey& place : blocks) numbers.insert(set.number_of(place));
  EXPECT_EQ(numbers.size(), blocks.size());
  EXPECT_EQ(*numbers.begin(), 0);
  EXPECT_EQ(*numbers.rbegin(), static_cast<std::int32_t>(blocks.size()) - 1);
  EXPECT_EQ(set.find({-1, 0, 0}), nullptr);
  EXPECT_EQ(set.number_of(set.blocks_along()), -1);
  std::vector<std::size_t> places;
  set.for_each_block([&](const CellKey& place, const CellSet::Block& block) {
    EXPECT_EQ(&block, set.find(place));
    places.push_back(set.index_of(place));
  });
  EXPECT_EQ(places.size(), blocks.size());
  EXPECT_TRUE(std::is_sorted(places.begin(), places.end()));
}

TEST(CellSet, AnEmptyOneHoldsNothing) {
  const CellSet set;
  EXPECT_FALSE(set.contains({0, 0, 0}));
  EXPECT_EQ(set.size() + set.block_count() + set.tile_count(), 0u);
  set.for_each([](const CellKey&) { FAIL() << "a cell"; });
}

// A tunnel 3 km long along x, 9 x 9 cells of 0.2 m wide, in bounds of 3 x 2 x 2 km, and its wall.
constexpr CellKey kWideLow{0, 0, 0}, kWideHigh{14999, 9999, 9999};
constexpr std::int32_t kFirst = 100, kEnd = 14900, kMiddle = 5000;
constexpr std::size_t kTunnelCells = std::size_t{kEnd - kFirst} * 9 * 9;
// Cells 4996 to 5004 lie in two blocks across, and 100 to 14899 in 1851 blocks along, of 117 tiles.
constexpr std::size_t kTunnelBlocks = 2 * 2 * 1851, kTunnelTiles = 117;

enum class Wall { closed, with_a_hole };

CellSet wall_of_tunnel(Wall wall) {
  CellSet rock(kWideLow, kWideHigh);
  for (std::int32_t x = kFirst - 1; x <= kEnd; ++x)
    for (std::int32_t y = -5; y <= 5; ++y)
      for (std::int32_t z = -5; z <= 5; ++z) {
        const bool side = std::max(std::abs(y), std::abs(z)) == 5, end = x < kFirst || x == kEnd;
        const bool hole = wall == Wall::with_a_hole && y == 5 && std::abs(z) <= 1 && std::abs(x - 7000) <= 1;
        if ((side || end) && !hole) rock.insert({x, kMiddle + y, kMiddle + z});
      }
  return rock;
}

TEST(Flood, MemoryFollowsALongThinTunnel) {
  CellSet tunnel(kWideLow, kWideHigh);
  for (std::int32_t x = kFirst; x < kEnd; ++x)
    for (std::int32_t y = -4; y <= 4; ++y)
      for (std::int32_t z = -4; z <= 4; ++z) tunnel.insert({x, kMiddle + y, kMiddle + z});
  tunnel.insert({10, 10, 10});
  const CellSet filled = flood(tunnel, {kFirst, kMiddle, kMiddle});
  EXPECT_EQ(filled.size(), kTunnelCells);
  EXPECT_FALSE(filled.contains({10, 10, 10}));
  EXPECT_EQ(filled.block_count(), kTunnelBlocks);
  EXPECT_EQ(filled.tile_count(), kTunnelTiles);
}

TEST(Flood, MemoryFollowsTheSpaceWithinAWall) {
  const CellSet rock = wall_of_tunnel(Wall::closed);
  const std::optional<CellSet> inside = flood_between(rock, {kFirst, kMiddle, kMiddle});
  ASSERT_TRUE(inside);
  EXPECT_EQ(inside->size(), kTunnelCells);
  EXPECT_EQ(inside->block_count(), kTunnelBlocks);
  EXPECT_EQ(inside->tile_count(), kTunnelTiles);
}

TEST(Flood, AHoleFarFromTheBoundsLeadsOutAndIsFound) {
  const CellSet rock = wall_of_tunnel(Wall::with_a_hole);
  const CellKey start{6500, kMiddle, kMiddle};
  EXPECT_FALSE(flood_between(rock, start));
  EXPECT_FALSE(flood_between(rock, {7000, 1000, 1000})) << "from outside";
  const CellKey opening = find_opening(rock, start);
  EXPECT_LE(std::abs(opening.x - 7000), 5);
  EXPECT_LE(std::abs(opening.y - (kMiddle + 5)), 5);
  EXPECT_LE(std::abs(opening.z - kMiddle), 5);
}

}  // namespace
