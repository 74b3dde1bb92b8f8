// Insertion against closed forms and against stock OctoMap.
#include <gtest/gtest.h>
#include <octomap/octomap.h>
#include <rapidcheck.h>

#include "core_stack/mapping/octomap/octomap_io.h"
#include "tests/unit/mapping/scenes.h"

namespace karst::core {
namespace {

constexpr double kHit = 0.8472979, kMiss = -0.4054651;  // log-odds of 0.7 and 0.4
constexpr double kStep = 1.0 / 4096;                    // the map's unit of log-odds

Ray ray(const Vec3f& from, const Vec3f& to, bool hit = true) { return {from, to, hit}; }
const Vec3f kOrigin(0.1f, 0.1f, 0.1f);

TEST(Insert, AHitAndThePassedCellsGetTheirLogOdds) {
  VoxelMap map{scenes::octomap_options()};
  map.insert(std::vector{ray(kOrigin, {2.1f, 0.1f, 0.1f})});
  EXPECT_NEAR(*map.log_odds({10, 0, 0}), kHit, kStep);
  for (int x = 0; x < 10; ++x) EXPECT_NEAR(*map.log_odds({x, 0, 0}), kMiss, kStep);
  EXPECT_EQ(map.free_cells(), 10u);
  EXPECT_EQ(map.occupied_cells(), 1u);
}

TEST(Insert, ARayWithoutAHitFreesAllButItsEnd) {
  VoxelMap map{scenes::octomap_options()};
  map.insert(std::vector{ray(kOrigin, {2.1f, 0.1f, 0.1f}, false)});
  EXPECT_EQ(map.free_cells(), 10u);
  EXPECT_EQ(map.at(CellKey{10, 0, 0}), Cell::unknown);
}

TEST(Insert, LogOddsStayWithinTheClampingValues) {
  VoxelMap map{scenes::octomap_options()};
  for (int i = 0; i < 30; ++i) map.insert(std::vector{ray(kOrigin, {2.1f, 0.1f, 0.1f})});
  EXPECT_NEAR(*map.log_odds({10, 0, 0}), std::log(0.97 / 0.03), kStep);
  EXPECT_NEAR(*map.log_odds({5, 0, 0}), std::log(0.12 / 0.88), kStep);
  // From full occupied (3.476) it takes 9 misses of 0.405 to become free.
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(map.at(CellKey{10, 0, 0}), Cell::occupied) << i;
    map.insert(std::vector{ray(kOrigin, {3.1f, 0.1f, 0.1f})});
  }
  EXPECT_EQ(map.at(CellKey{10, 0, 0}), Cell::free);
}

TEST(Insert, WithinAScanEachCellChangesOnceAndAHitWinsOverMisses) {
  VoxelMap map{scenes::octomap_options()};
  std::vector<Ray> scan;
  for (int i = 0; i < 8; ++i) {
    const float y = 0.1f + 0.01f * static_cast<float>(i);
    scan.push_back(ray(kOrigin, {2.1f, y, 0.1f}));
    scan.push_back(ray(kOrigin, {4.1f, y, 0.1f}));  // passes where the others hit
  }
  map.insert(scan);
  EXPECT_NEAR(*map.log_odds({10, 0, 0}), kHit, kStep);
  EXPECT_NEAR(*map.log_odds({20, 0, 0}), kHit, kStep);
  EXPECT_NEAR(*map.log_odds({5, 0, 0}), kMiss, kStep);
  EXPECT_NEAR(*map.log_odds({15, 0, 0}), kMiss, kStep);
}

TEST(Insert, RaysToOneCellFromDifferentOriginsAreAllCast) {
  VoxelMap map{scenes::octomap_options()};
  map.insert(std::vector{ray({-3.1f, 0.1f, 0.1f}, kOrigin), ray({0.1f, 3.1f, 0.1f}, kOrigin)});
  EXPECT_EQ(map.at(Vec3(-1.5, 0.1, 0.1)), Cell::free);
  EXPECT_EQ(map.at(Vec3(0.1, 1.5, 0.1)), Cell::free);
  // More origins than the ray set numbers.
  VoxelMap many{scenes::octomap_options()};
  std::vector<Ray> fan;
  for (int i = 0; i < 200; ++i)
    fan.push_back(ray({0.1f + 0.2f * static_cast<float>(i), 5.1f, 0.1f}, {20.1f, 0.1f, 0.1f}));
  many.insert(fan);
  for (int i = 0; i < 200; ++i) EXPECT_EQ(many.at(Vec3(0.1 + 0.2 * i, 5.1, 0.1)), Cell::free) << i;
}

TEST(Insert, IgnoresRaysThatAreNoRays) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  VoxelMap map{scenes::octomap_options()};
  const auto changes = map.insert(std::vector{ray({nan, 0, 0}, {1, 1, 1}), ray({0, 0, 0}, {1, nan, 1}),
                                              ray({0, 0, 0}, {inf, 0, 0}), ray({0, -inf, 0}, {1, 0, 0}),
                                              ray({0, 0, 0}, {1e30f, 0, 0}), ray({0, 0, 0}, {0, 0, 7000}),
                                              ray({-9e9f, 0, 0}, {-9e9f, 1, 0})});
  EXPECT_TRUE(changes.empty());
  EXPECT_EQ(map.free_cells() + map.occupied_cells(), 0u);
  EXPECT_TRUE(map.insert({}).empty());
}

TEST(Insert, WorksUpToTheWorldsEdge) {
  VoxelMap map{scenes::octomap_options()};
  map.insert(std::vector{ray({6553.0f, 0.1f, 0.1f}, {6553.5f, 0.1f, 0.1f}),
                         ray({0.1f, -6553.0f, 0.1f}, {0.1f, -6553.5f, 0.1f})});
  EXPECT_EQ(map.at(Vec3(6553.5, 0.1, 0.1)), Cell::occupied);
  EXPECT_EQ(map.at(Vec3(0.1, -6553.5, 0.1)), Cell::occupied);
}

TEST(Insert, GivesTheSameMapAndChangesEveryTime) {
  const auto run = [] {
    Random random(31);
    VoxelMap map{scenes::octomap_options()};
    std::vector<std::int32_t> trace;
    for (int i = 0; i < 4; ++i)
      for (const CellChange& c : map.insert(scenes::random_scan(random, 500, 8)))
        trace.insert(trace.end(), {c.key.x, c.key.y, c.key.z, static_cast<int>(c.after)});
    return trace;
  };
  EXPECT_EQ(run(), run());
}

/// A scan is marked in an array over its box, and otherwise where that would be too large.
TEST(Insert, ARayFarFromTheOthersChangesNothingAboutThem) {
  Random random(7);
  VoxelMap map{scenes::octomap_options()}, with_far_ray{scenes::octomap_options()};
  for (int i = 0; i < 3; ++i) {
    std::vector<Ray> scan = scenes::random_scan(random, 3000, 8);
    map.insert(scan);
    scan.insert(scan.begin() + 1500, ray({3000.1f, 3000.1f, 500.1f}, {3002.1f, 3000.1f, 500.1f}));
    with_far_ray.insert(scan);
  }
  EXPECT_EQ(with_far_ray.at(Vec3(3001, 3000.1, 500.1)), Cell::free);
  EXPECT_EQ(with_far_ray.at(Vec3(3002.1, 3000.1, 500.1)), Cell::occupied);
  EXPECT_EQ(with_far_ray.free_cells(), map.free_cells() + 10);
  EXPECT_EQ(with_far_ray.occupied_cells(), map.occupied_cells() + 1);
  EXPECT_GT(map.free_cells(), 1000u);
  map.for_each_known(
      [&](const CellKey& k, Cell, float log_odds) { ASSERT_EQ(with_far_ray.log_odds(k), log_odds); });
}

void insert_into(octomap::OcTree& tree, const std::vector<Ray>& rays, double max_range_m) {
  octomap::Pointcloud cloud;
  const Vec3f o = rays.front().origin;
  for (const Ray& r : rays) {
    const Vec3f p = r.hit ? r.end : Vec3f(o + (r.end - o) * 2.0f);
    cloud.push_back(p.x(), p.y(), p.z());
  }
  tree.insertPointCloud(cloud, octomap::point3d(o.x(), o.y(), o.z()), max_range_m);
}

Cell class_in(const octomap::OcTree& tree, const CellKey& k) {
  const auto part = [](int v) { return static_cast<octomap::key_type>(v + 32768); };
  const auto* node = tree.search(octomap::OcTreeKey(part(k.x), part(k.y), part(k.z)));
  if (node == nullptr) return Cell::unknown;
  return tree.isNodeOccupied(node) ? Cell::occupied : Cell::free;
}

TEST(Insert, AgreesWithStockOctoMapOnScansOfARoom) {
  Random random(13);
  VoxelMap map{scenes::octomap_options()};
  octomap::OcTree tree(0.2);
  const double max_range_m = 8;  // the room's far ends are out of range
  for (int i = 0; i < 6; ++i) {
    const Vec3 origin(0.37 + 0.6 * i, 0.23, 1.31);
    const auto scan =
        scenes::room_scan(origin, Vec3(-4, -3, 0), Vec3(12, 3.3, 3.1), 20000, max_range_m, 0.02, random);
    map.insert(scan);
    insert_into(tree, scan, max_range_m);
  }
  std::size_t same = 0, cells = 0;
  for (int x = -60; x < 70; ++x)
    for (int y = -30; y < 30; ++y)
      for (int z = -10; z < 30; ++z) {
        const Cell ours = map.at(CellKey{x, y, z}), theirs = class_in(tree, {x, y, z});
        if (ours == Cell::unknown && theirs == Cell::unknown) continue;
        ++cells, same += ours == theirs;
      }
  EXPECT_GT(cells, 20000u);
  EXPECT_GE(static_cast<double>(same) / static_cast<double>(cells), 0.999);
}

TEST(Insert, OneRayLeavesThePreciseLogOddsOfOctoMap) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random random(seed);
    const auto point = [&] {
      return Vec3(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4)).cast<float>().eval();
    };
    const std::vector<Ray> scan{ray(point(), point())};
    VoxelMap map{scenes::octomap_options()};
    octomap::OcTree tree(0.2);
    map.insert(scan);
    insert_into(tree, scan, -1);
    // A border that the ray grazes may fall to either neighbour: rounding differs.
    std::size_t cells = 0, other = 0;
    map.for_each_known([&](const CellKey& k, Cell c, float) { ++cells, other += class_in(tree, k) != c; });
    RC_ASSERT(other <= 1u + cells / 50);
    RC_ASSERT(map.occupied_cells() == 1u);
  }));
}

}  // namespace
}  // namespace karst::core
