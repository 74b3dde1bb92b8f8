#include "core_stack/mapping/frontiers/frontiers.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <set>

#include "tests/unit/mapping/scenes.h"

namespace karst::core {
namespace {

const std::vector<CellKey> kFaceNeighbours{{-1, 0, 0}, {1, 0, 0},  {0, -1, 0},
                                           {0, 1, 0},  {0, 0, -1}, {0, 0, 1}};

/// The definition, applied to the whole map.
std::set<CellKey> frontier_cells(const VoxelMap& map) {
  std::set<CellKey> cells;
  map.for_each_known([&](const CellKey& k, Cell c, float) {
    if (c != Cell::free) return;
    for (const CellKey& f : kFaceNeighbours)
      if (map.at(k + f) == Cell::unknown) cells.insert(k);
  });
  return cells;
}

using Partition = std::set<std::vector<CellKey>>;

/// Components of at least min_cells: cells of one tile that touch, by faces, edges or corners.
Partition partition(std::set<CellKey> cells, int tile, std::size_t min_cells) {
  const auto tile_of = [tile](const CellKey& k) {
    const auto part = [tile](int v) { return static_cast<int>(std::floor(static_cast<double>(v) / tile)); };
    return CellKey{part(k.x), part(k.y), part(k.z)};
  };
  Partition result;
  while (!cells.empty()) {
    std::vector<CellKey> component{*cells.begin()};
    cells.erase(cells.begin());
    for (std::size_t i = 0; i < component.size(); ++i)
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy)
          for (int dz = -1; dz <= 1; ++dz) {
            const CellKey n = component[i] + CellKey{dx, dy, dz};
            if (tile_of(n) == tile_of(component[i]) && cells.erase(n) > 0) component.push_back(n);
          }
    std::sort(component.begin(), component.end());
    if (component.size() >= min_cells) result.insert(component);
  }
  return result;
}

Partition partition_of(const Frontiers& frontiers) {
  Partition result;
  for (const auto& [id, c] : frontiers.clusters()) result.insert(c.cells);
  return result;
}

TEST(Frontiers, AMapWithoutFreeCellsHasNone) {
  const VoxelMap map{MapOptions{}};
  Frontiers frontiers{FrontierOptions{}};
  frontiers.update(map, {});
  EXPECT_TRUE(frontiers.clusters().empty());
  EXPECT_EQ(frontiers.cell_count(), 0u);
  EXPECT_FALSE(frontiers.is_frontier({0, 0, 0}));
}

TEST(Frontiers, AfterAnyInsertionsEqualARecomputationFromScratch) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random random(seed);
    VoxelMap map{MapOptions{}};
    FrontierOptions options;
    options.tile_m = random.uniform() < 0.5 ? 1.6 : 3.2;
    Frontiers frontiers(options);
    const int tile = static_cast<int>(std::lround(options.tile_m / 0.2));
    std::vector<CellChange> pending;
    for (int scan = 0; scan < 4; ++scan) {
      const auto changes =
          scan == 0 ? map.declare_free(Vec3(0, 0, 0), 1.0) : map.insert(scenes::random_scan(random, 60, 3));
      pending.insert(pending.end(), changes.begin(), changes.end());
      if (random.uniform() < 0.3) continue;  // several insertions in one update
      frontiers.update(map, pending);
      pending.clear();
      const std::set<CellKey> expected = frontier_cells(map);
      RC_ASSERT(frontiers.cell_count() == expected.size());
      map.for_each_known([&](const CellKey& k, Cell, float) {
        RC_ASSERT(frontiers.is_frontier(k) == expected.contains(k));
      });
      RC_ASSERT(partition_of(frontiers) ==
                partition(expected, tile, static_cast<std::size_t>(options.min_cells)));
    }
  }));
}

TEST(Frontiers, EveryFigureOfAClusterHoldsForTheMapAsItIs) {
  Random random(77);
  VoxelMap map{MapOptions{}};
  const FrontierOptions options;
  Frontiers frontiers(options);
  for (int scan = 0; scan < 5; ++scan) {
    frontiers.update(map, map.insert(scenes::random_scan(random, 200, 5)));
    for (const auto& [id, c] : frontiers.clusters()) {
      EXPECT_EQ(id, c.id);
      Vec3 sum = Vec3::Zero(), normal = Vec3::Zero(), low = map.center_of(c.cells[0]), high = low;
      for (const CellKey& k : c.cells) {
        const Vec3 p = map.center_of(k);
        sum += p, low = low.cwiseMin(p), high = high.cwiseMax(p);
        for (const CellKey& f : kFaceNeighbours)
          if (map.at(k + f) == Cell::unknown) normal += Vec3(f.x, f.y, f.z);
      }
      const Vec3 half = Vec3::Constant(0.1);
      EXPECT_NEAR((c.centroid - sum / static_cast<double>(c.cells.size())).norm(), 0, 1e-9);
      EXPECT_NEAR((c.low - (low - half)).norm() + (c.high - (high + half)).norm(), 0, 1e-9);
      EXPECT_NEAR((c.normal - (normal.norm() > 0 ? normal.normalized() : normal)).norm(), 0, 1e-9);
      const Vec3 radius = Vec3::Constant(options.neighbourhood_m);
      const CellKey a = map.key_of(c.centroid - radius), b = map.key_of(c.centroid + radius);
      std::uint32_t free = 0, unknown = 0;
      for (int x = a.x; x <= b.x; ++x)
        for (int y = a.y; y <= b.y; ++y)
          for (int z = a.z; z <= b.z; ++z) {
            const Cell cell = map.at(CellKey{x, y, z});
            free += cell == Cell::free, unknown += cell == Cell::unknown;
          }
      EXPECT_EQ(c.free_cells, free) << "scan " << scan << ", cluster " << id;
      EXPECT_EQ(c.unknown_cells, unknown) << "scan " << scan << ", cluster " << id;
    }
  }
}

TEST(Frontiers, ClustersKeepTheirIdWhileTheyShareCellsAndNoIdComesBack) {
  Random random(5);
  VoxelMap map{MapOptions{}};
  Frontiers frontiers{FrontierOptions{}};
  std::map<std::uint32_t, FrontierCluster> before;
  std::uint32_t highest = 0, kept = 0;
  for (int scan = 0; scan < 10; ++scan) {
    frontiers.update(map, map.insert(scenes::random_scan(random, 200, 5)));
    for (const auto& [id, c] : frontiers.clusters()) {
      const auto former = before.find(id);
      if (former == before.end()) continue;
      ++kept;
      std::vector<CellKey> both;
      std::set_intersection(c.cells.begin(), c.cells.end(), former->second.cells.begin(),
                            former->second.cells.end(), std::back_inserter(both));
      EXPECT_FALSE(both.empty()) << "an id moved to other cells";
      // No other cluster would be the better heir.
      for (const auto& [other_id, other] : frontiers.clusters()) {
        std::vector<CellKey> fraction;
        std::set_intersection(other.cells.begin(), other.cells.end(), former->second.cells.begin(),
                              former->second.cells.end(), std::back_inserter(fraction));
        if (!before.contains(other_id)) {
          EXPECT_LE(fraction.size(), both.size());
        }
      }
    }
    for (const auto& [id, c] : frontiers.clusters()) highest = std::max(highest, id);
    before = frontiers.clusters();
  }
  EXPECT_GT(kept, 20u);
  EXPECT_GT(highest, frontiers.clusters().size()) << "ids are spent, not reused";
}

TEST(Frontiers, AClusterThatGrowsKeepsItsIdAndAnUntouchedOneIsLeftAlone) {
  VoxelMap map{MapOptions{}};
  Frontiers frontiers{FrontierOptions{}};
  frontiers.update(map, map.declare_free(Vec3(1.6, 1.6, 1.6), 0.8));
  frontiers.update(map, map.declare_free(Vec3(17.6, 1.6, 1.6), 0.8));
  ASSERT_EQ(frontiers.clusters().size(), 2u);
  const auto before = frontiers.clusters();
  frontiers.update(map, map.declare_free(Vec3(1.8, 1.6, 1.6), 0.8));
  ASSERT_EQ(frontiers.clusters().size(), 2u);
  auto a = before.begin(), b = frontiers.clusters().begin();
  EXPECT_EQ(a->first, b->first);
  EXPECT_NE(a->second.cells, b->second.cells);
  EXPECT_EQ((++a)->first, (++b)->first);
  EXPECT_EQ(a->second.cells, b->second.cells);
}

TEST(Frontiers, TheOpeningOfAKnownCorridorPointsOutOfIt) {
  VoxelMap map{MapOptions{}};
  // A corridor along x with walls, its far end open: y and z in 0..9, free from x = 0 to 19.
  for (int x = 0; x < 20; ++x)
    for (int y = -1; y <= 10; ++y)
      for (int z = -1; z <= 10; ++z) {
        const bool wall = x == 0 || y < 0 || y > 9 || z < 0 || z > 9;
        map.assign({x, y, z}, 1, wall ? 1.0f : -1.0f);
      }
  std::vector<CellChange> all;
  map.for_each_known([&](const CellKey& k, Cell c, float) { all.push_back({k, Cell::unknown, c}); });
  Frontiers frontiers{FrontierOptions{}};
  frontiers.update(map, all);
  ASSERT_EQ(frontiers.clusters().size(), 1u);
  const FrontierCluster& c = frontiers.clusters().begin()->second;
  EXPECT_EQ(c.cells.size(), 100u);
  EXPECT_NEAR((c.normal - Vec3::UnitX()).norm(), 0, 1e-12);
  EXPECT_NEAR((c.centroid - Vec3(3.9, 1.0, 1.0)).norm(), 0, 1e-12);
}

TEST(Frontiers, SmallClustersAreNotOffered) {
  VoxelMap map{MapOptions{}};
  FrontierOptions options;
  options.min_cells = 8;
  Frontiers frontiers(options);
  frontiers.update(map, map.insert(std::vector{Ray{{0.1f, 0.1f, 0.1f}, {1.1f, 0.1f, 0.1f}, true}}));
  EXPECT_EQ(frontiers.cell_count(), 5u);
  EXPECT_TRUE(frontiers.clusters().empty());
}

}  // namespace
}  // namespace karst::core
