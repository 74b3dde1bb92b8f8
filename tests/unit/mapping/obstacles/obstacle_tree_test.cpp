#include "core_stack/mapping/obstacles/obstacle_tree.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/mapping/scenes.h"

namespace karst::core {
namespace {

/// The definition: occupied cells of the box, and unknown ones with a free face neighbour.
std::vector<Vec3> obstacles(const VoxelMap& map, const Vec3& low, const Vec3& high) {
  std::vector<Vec3> centers;
  const CellKey a = map.key_of(low), b = map.key_of(high);
  for (int x = a.x; x <= b.x; ++x)
    for (int y = a.y; y <= b.y; ++y)
      for (int z = a.z; z <= b.z; ++z) {
        const auto is_free = [&](int dx, int dy, int dz) {
          return map.at(CellKey{x + dx, y + dy, z + dz}) == Cell::free;
        };
        const Cell c = map.at(CellKey{x, y, z});
        const bool edge = c == Cell::unknown && (is_free(1, 0, 0) || is_free(-1, 0, 0) || is_free(0, 1, 0) ||
                                                 is_free(0, -1, 0) || is_free(0, 0, 1) || is_free(0, 0, -1));
        if (c == Cell::occupied || edge) centers.push_back(map.center_of({x, y, z}));
      }
  return centers;
}

TEST(ObstacleTree, AnswersAsBruteForceDoes) {
  Random random(41);
  VoxelMap map{MapOptions{}};
  for (int i = 0; i < 5; ++i) map.insert(scenes::random_scan(random, 300, 7));
  // The second box cuts through the map: neighbours outside it count, obstacles outside it do not.
  const std::pair<Vec3, Vec3> boxes[] = {{Vec3(-11, -11, -11), Vec3(11, 11, 11)},
                                         {Vec3(-1.3, -2, 0), Vec3(2.1, 0.3, 3)}};
  for (const auto& [low, high] : boxes) {
    const ObstacleTree tree(map, low, high);
    const std::vector<Vec3> all = obstacles(map, low, high);
    ASSERT_EQ(tree.size(), all.size());
    ASSERT_GT(all.size(), 50u);
    for (int i = 0; i < 300; ++i) {
      const Vec3 p(random.uniform(-8, 8), random.uniform(-8, 8), random.uniform(-8, 8));
      double best = std::numeric_limits<double>::infinity();
      for (const Vec3& c : all) best = std::min(best, (c - p).norm());
      EXPECT_NEAR(tree.distance(p), best, 1e-5);  // centres are stored as float
      Vec3 center;
      double distance_m = 0;
      ASSERT_TRUE(tree.nearest(p, center, distance_m));
      EXPECT_NEAR((center - p).norm(), distance_m, 1e-9);
      EXPECT_NEAR(distance_m, best, 1e-5);
      EXPECT_TRUE(tree.any_within(p, best + 1e-4));
      EXPECT_FALSE(tree.any_within(p, best - 1e-4));
    }
  }
}

TEST(ObstacleTree, OfNothingIsInfinitelyFar) {
  const VoxelMap map{MapOptions{}};
  ObstacleTree tree(map, Vec3(-5, -5, -5), Vec3(5, 5, 5));
  EXPECT_EQ(tree.size(), 0u);
  EXPECT_EQ(tree.distance(Vec3(0, 0, 0)), std::numeric_limits<double>::infinity());
  EXPECT_FALSE(tree.any_within(Vec3(0, 0, 0), 100));
  Vec3 center;
  double distance_m = 0;
  EXPECT_FALSE(tree.nearest(Vec3(0, 0, 0), center, distance_m));
}

TEST(ObstacleTree, KeepsItsAnswersWhenTheMapChangesAndWhenMoved) {
  VoxelMap map{MapOptions{}};
  map.assign({10, 0, 0}, 1, 1.0f);
  ObstacleTree tree(map, Vec3(-5, -5, -5), Vec3(5, 5, 5));
  map.assign({2, 0, 0}, 1, 1.0f);
  const ObstacleTree moved = std::move(tree);
  EXPECT_NEAR(moved.distance(Vec3(0.1, 0.1, 0.1)), 2.0, 1e-6);
  EXPECT_EQ(moved.distance(Vec3(std::nan(""), 0, 0)), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace karst::core
