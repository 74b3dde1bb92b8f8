#include "core_stack/mapping/occupancy/voxel_map.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <map>
#include <set>
#include <thread>

#include "core_stack/mapping/occupancy/voxel_reader.h"
#include "tests/unit/mapping/scenes.h"

namespace karst::core {
namespace {

using Classes = std::map<CellKey, Cell>;

Classes classes_of(const VoxelMap& map) {
  Classes all;
  map.for_each_known([&](const CellKey& k, Cell c, float) { all[k] = c; });
  return all;
}

VoxelMap random_map(std::uint64_t seed, int scans = 3) {
  Random random(seed);
  VoxelMap map{MapOptions{}};
  for (int i = 0; i < scans; ++i) map.insert(scenes::random_scan(random, 200, 6));
  return map;
}

TEST(VoxelMap, IsUnknownEverywhereAtFirst) {
  const VoxelMap map{MapOptions{}};
  EXPECT_EQ(map.at(Vec3(0, 0, 0)), Cell::unknown);
  EXPECT_EQ(map.free_cells() + map.occupied_cells(), 0u);
  EXPECT_EQ(map.first_not_free(Vec3(0.1, 0, 0), Vec3(5, 0, 0)), (CellKey{0, 0, 0}));
  EXPECT_EQ(map.first_occupied(Vec3(0, 0, 0), Vec3(5, 0, 0)), std::nullopt);
  EXPECT_EQ(map.revision_near(Vec3(0, 0, 0), 100), 0u);
  map.for_each_known([](const CellKey&, Cell, float) { FAIL(); });
}

TEST(VoxelMap, KeysAndCentresAgree) {
  const VoxelMap map{MapOptions{}};
  EXPECT_EQ(map.key_of(Vec3(-0.01, 0.01, 0.39)), (CellKey{-1, 0, 1}));
  EXPECT_NEAR((map.center_of({-1, 0, 1}) - Vec3(-0.1, 0.1, 0.3)).norm(), 0, 1e-12);
  for (int i = -40; i < 40; ++i)
    EXPECT_EQ(map.key_of(map.center_of({i, 3 * i, -i})), (CellKey{i, 3 * i, -i}));
}

TEST(VoxelMap, IsUnknownOutsideTheWorldAndForNoPlace) {
  VoxelMap map{MapOptions{}};
  map.declare_free(Vec3(0, 0, 0), 1);
  for (const double v : {1e5, -1e5, 1e18, -1e300, std::nan(""), HUGE_VAL}) {
    EXPECT_EQ(map.at(Vec3(v, 0, 0)), Cell::unknown);
    EXPECT_EQ(map.at(Vec3(0, 0, v)), Cell::unknown);
    EXPECT_EQ(map.first_occupied(Vec3(0, 0, 0), Vec3(v, 0, 0)), std::nullopt);
    EXPECT_TRUE(map.first_not_free(Vec3(0.1, 0.1, 0.1), Vec3(0.1, v, 0.1)).has_value());
    EXPECT_TRUE(map.first_not_free(Vec3(0.1, v, 0.1), Vec3(0.1, 0.1, 0.1)).has_value());
    map.revision_near(Vec3(v, 0, 0), 1);
  }
  EXPECT_EQ(map.at(CellKey{0 + 65536, 0, 0}), Cell::unknown) << "coordinates must not wrap around";
}

TEST(VoxelMap, CountsAndChangesMatchWhatIsInTheMap) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random random(seed);
    VoxelMap map{MapOptions{}};
    Classes before;
    for (int scan = 0; scan < 4; ++scan) {
      const auto changes = scan == 2 ? map.declare_free(Vec3(random.uniform(-2, 2), 0, 0), 1.3)
                                     : map.insert(scenes::random_scan(random, 60, 4));
      const Classes after = classes_of(map);
      RC_ASSERT(std::is_sorted(changes.begin(), changes.end(),
                               [](const CellChange& a, const CellChange& b) { return a.key < b.key; }));
      Classes replayed = before;
      for (const CellChange& c : changes) {
        RC_ASSERT(c.before != c.after);
        RC_ASSERT(c.before == (before.contains(c.key) ? before.at(c.key) : Cell::unknown));
        replayed[c.key] = c.after;
      }
      RC_ASSERT(replayed == after);
      std::size_t free = 0;
      for (const auto& [k, c] : after) free += c == Cell::free;
      RC_ASSERT(map.free_cells() == free);
      RC_ASSERT(map.occupied_cells() == after.size() - free);
      before = after;
    }
  }));
}

TEST(VoxelMap, AtAndReaderAgreeWithTheListOfKnownCells) {
  const VoxelMap map = random_map(4);
  const Classes all = classes_of(map);
  VoxelReader reader(map);
  for (int x = -45; x < 45; ++x)
    for (int y = -45; y < 45; ++y)
      for (int z = -45; z < 45; ++z) {
        const auto it = all.find({x, y, z});
        const Cell expected = it == all.end() ? Cell::unknown : it->second;
        ASSERT_EQ(map.at(CellKey{x, y, z}), expected);
        ASSERT_EQ(reader.at({x, y, z}), expected);
        ASSERT_EQ(map.log_odds({x, y, z}).has_value(), expected != Cell::unknown);
      }
}

TEST(VoxelMap, BoxesListAndCountTheirKnownCells) {
  const VoxelMap map = random_map(9);
  const Classes all = classes_of(map);
  Random random(1);
  for (int i = 0; i < 60; ++i) {
    const auto coordinate = [&](double reach) { return static_cast<int>(random.uniform(-reach, reach)); };
    const double reach = i % 10 == 0 ? 30000 : 40;  // some boxes much larger than the map
    const CellKey a{coordinate(reach), coordinate(reach), coordinate(reach)};
    const CellKey b{coordinate(reach), coordinate(reach), coordinate(reach)};
    const CellKey low{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
    const CellKey high{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
    Classes expected;
    for (const auto& [k, c] : all)
      if (k.x >= low.x && k.x <= high.x && k.y >= low.y && k.y <= high.y && k.z >= low.z && k.z <= high.z)
        expected[k] = c;
    Classes listed;
    map.for_each_in_box(low, high,
                        [&](const CellKey& k, Cell c) { EXPECT_TRUE(listed.emplace(k, c).second); });
    EXPECT_EQ(listed, expected);
    if (reach > 40) continue;
    const std::vector<Cell> classes = VoxelReader(map).classes(low, high);
    std::size_t index = 0;
    for (CellKey k = low; k.z <= high.z; ++k.z)
      for (k.y = low.y; k.y <= high.y; ++k.y)
        for (k.x = low.x; k.x <= high.x; ++k.x) ASSERT_EQ(classes.at(index++), map.at(k));
    EXPECT_EQ(classes.size(), index);
    const CellCounts counts = VoxelReader(map).count(low, high);
    const auto free =
        std::count_if(expected.begin(), expected.end(), [](auto& e) { return e.second == Cell::free; });
    EXPECT_EQ(counts.free, free);
    EXPECT_EQ(counts.free + counts.occupied, expected.size());
    EXPECT_EQ(counts.free + counts.occupied + counts.unknown,
              static_cast<std::size_t>(high.x - low.x + 1) * (high.y - low.y + 1) * (high.z - low.z + 1));
  }
}

TEST(VoxelMap, ListsKnownCellsBlockByBlockXFastest) {
  const VoxelMap map = random_map(3);
  std::vector<std::array<int, 6>> order;
  map.for_each_known([&](const CellKey& k, Cell, float) {
    order.push_back({k.x >> 3, k.y >> 3, k.z >> 3, k.z, k.y, k.x});
  });
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(VoxelMap, FindsTheFirstCellThatIsNotFreeOrOccupied) {
  const VoxelMap map = random_map(21, 6);
  Random random(8);
  for (int i = 0; i < 200; ++i) {
    const auto point = [&] {
      return Vec3(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4));
    };
    const Vec3 a = point(), b = point();
    std::optional<CellKey> not_free, occupied;
    traverse(a, b, map.resolution_m(), [&](const CellKey& k) {
      if (!not_free && map.at(k) != Cell::free) not_free = k;
      if (!occupied && map.at(k) == Cell::occupied) occupied = k;
      return true;
    });
    EXPECT_EQ(map.first_not_free(a, b), not_free);
    EXPECT_EQ(map.first_occupied(a, b), occupied);
  }
}

TEST(VoxelMap, DeclaredBallIsFreeAndLeavesKnownCellsAlone) {
  VoxelMap map = random_map(6);
  const Classes before = classes_of(map);
  const Vec3 center(0.3, -0.2, 0.1);
  map.declare_free(center, 2.0);
  for (const auto& [k, c] : classes_of(map)) {
    const auto known = before.find(k);
    if (known != before.end()) {
      EXPECT_EQ(c, known->second);
    } else {
      EXPECT_EQ(c, Cell::free);
      EXPECT_LE((map.center_of(k) - center).norm(), 2.0);
    }
  }
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = center + scenes::direction(i, 500) * (1.8 * i / 500);
    EXPECT_NE(map.at(p), Cell::unknown);
  }
}

TEST(VoxelMap, RevisionStandsWhileNothingNearChanges) {
  VoxelMap map{MapOptions{}};
  map.declare_free(Vec3(0, 0, 0), 1);
  map.declare_free(Vec3(30, 0, 0), 1);
  EXPECT_EQ(map.revision(), 2u);
  EXPECT_EQ(map.revision_near(Vec3(0, 0, 0), 1), 1u);
  EXPECT_EQ(map.revision_near(Vec3(30, 0, 0), 1), 2u);
  EXPECT_EQ(map.revision_near(Vec3(15, 0, 0), 1), 0u);
  EXPECT_EQ(map.revision_near(Vec3(15, 0, 0), 1e6), 2u);
  map.declare_free(Vec3(0, 0, 0), 1);  // changes no class
  EXPECT_EQ(map.revision_near(Vec3(0, 0, 0), 1), 1u);
}

TEST(VoxelMap, AssignedCubesHoldTheirValue) {
  VoxelMap map{MapOptions{}};
  map.assign({-3, 5, 60}, 11, -1.25f);
  EXPECT_EQ(map.free_cells(), 11u * 11 * 11);
  EXPECT_EQ(map.log_odds({7, 15, 70}), -1.25f);
  map.assign({-3, 5, 60}, 1, 2.0f);
  EXPECT_EQ(map.free_cells(), 11u * 11 * 11 - 1);
  EXPECT_EQ(map.at(CellKey{-3, 5, 60}), Cell::occupied);
  map.assign({32766, 0, 0}, 8, 1.0f);
  EXPECT_EQ(map.occupied_cells(), 1u + 2 * 8 * 8) << "only what lies in the world";
}

TEST(VoxelMap, SeveralReadersSeeTheSame) {
  const VoxelMap map = random_map(17, 6);
  const auto sum = [&] {
    std::size_t n = 0;
    for (int x = -40; x < 40; ++x)
      for (int y = -40; y < 40; ++y)
        for (int z = -40; z < 40; ++z) n = 3 * n + static_cast<std::size_t>(map.at(CellKey{x, y, z}));
    return n;
  };
  std::vector<std::size_t> sums(4);
  std::vector<std::thread> threads;
  for (auto& s : sums) threads.emplace_back([&] { s = sum(); });
  for (auto& t : threads) t.join();
  EXPECT_EQ(std::set<std::size_t>(sums.begin(), sums.end()).size(), 1u);
}

TEST(VoxelMap, OptionsAreDescribedWithTheirDefaultsInRange) {
  MapOptions options;
  OptionTable table;
  describe(table, options);
  EXPECT_EQ(table.rows().size(), 5u);
  for (const auto& row : table.rows()) {
    const double value = *std::get<double*>(row.target);
    EXPECT_TRUE(value >= row.low && value <= row.high) << row.key;
  }
}

}  // namespace
}  // namespace karst::core
