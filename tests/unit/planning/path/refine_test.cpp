#include "core_stack/planning/path/refine.h"

#include <gtest/gtest.h>

#include "core_stack/planning/search/grid_planner.h"
#include "tests/unit/planning/oracles.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

using testing::Obstacles;
using testing::WindingCave;

double min_clearance(const Obstacles& obstacles, const std::vector<Vec3>& points) {
  double least = 1e9;
  for (std::size_t i = 1; i < points.size(); ++i)
    least = std::min(least, obstacles.distance(points[i - 1], points[i]));
  return least;
}

double mean_clearance(const Obstacles& obstacles, const std::vector<Vec3>& points) {
  double sum = 0;
  for (const Vec3& p : points) sum += std::min(1.4, obstacles.distance(p));
  return sum / static_cast<double>(points.size());
}

TEST(Refine, IsHardlyLongerAndNeverLessClearAndKeepsTheEnds) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const WindingCave cave = WindingCave::of_length(13, seed, 1.4);
    const VoxelMap map = cave.map();
    const PlanningOptions options = kOptions;
    const Path raw = plan_on_grid(map, cave.line[3], cave.line[cave.line.size() - 4], options);
    ASSERT_TRUE(raw.found()) << raw.reason;
    const std::vector<Vec3> fine = refine_path(map, raw.points, options);
    EXPECT_EQ(fine.front(), raw.points.front());
    EXPECT_EQ(fine.back(), raw.points.back());
    EXPECT_LE(path_length_m(fine), 1.05 * raw.length_m);
    EXPECT_GE(min_clearance(Obstacles(map), fine), options.clearance_m - 1e-6);
    EXPECT_EQ(first_blocked_segment(map, fine, options.clearance_m), -1);
  }
}

TEST(Refine, PushesOutToThePreferredClearanceWhereThereIsRoom) {
  // A wall to pass on the way along a large hall; the shortest way hugs its edge.
  VoxelMap map{MapOptions{}};
  testing::draw(map, {0, 0, 0}, {49, 39, 19}, [](const CellKey& k) {
    return k.x >= 24 && k.x <= 25 && k.y < 20 ? Cell::occupied : Cell::free;
  });
  const PlanningOptions options = kOptions;
  const Path raw = plan_on_grid(map, {1.5, 2.0, 2.0}, {8.5, 2.0, 2.0}, options);
  ASSERT_TRUE(raw.found());
  const std::vector<Vec3> fine = refine_path(map, raw.points, options);
  EXPECT_LT(min_clearance(Obstacles(map), raw.points), 0.7);
  EXPECT_GT(min_clearance(Obstacles(map), fine), 0.8);
  EXPECT_GT(mean_clearance(Obstacles(map), fine), mean_clearance(Obstacles(map), raw.points));
}

TEST(Refine, BendsAreRoundEnoughToFly) {
  VoxelMap map{MapOptions{}};
  testing::draw(map, {0, 0, 0}, {49, 49, 19},
                [](const CellKey& k) { return k.x < 30 && k.y >= 20 ? Cell::occupied : Cell::free; });
  const Path raw = plan_on_grid(map, {1.5, 2.0, 2.0}, {8.0, 8.5, 2.0}, kOptions);
  ASSERT_TRUE(raw.found());
  const std::vector<Vec3> fine = refine_path(map, raw.points, kOptions);
  double sharpest = 0;
  for (std::size_t i = 1; i + 1 < fine.size(); ++i) {
    const Vec3 a = fine[i] - fine[i - 1], b = fine[i + 1] - fine[i];
    sharpest = std::max(sharpest, std::atan2(a.cross(b).norm(), a.dot(b)) / (0.5 * (a.norm() + b.norm())));
  }
  // Around a corner at about a metre's distance: 1.2 m/s at 2 m/s^2 takes a radius of 0.7 m.
  EXPECT_LT(sharpest, 1.4);
}

TEST(Refine, LiftsASqueezedPathToTheFullClearance) {
  // Five free cells wide and high: centres reach 0.4 m at best, the middle 0.5 m.
  VoxelMap map{MapOptions{}};
  testing::draw(map, {0, 0, 0}, {39, 6, 6}, [](const CellKey& k) {
    return k.y == 0 || k.y == 6 || k.z == 0 || k.z == 6 ? Cell::occupied : Cell::free;
  });
  // The middle of an even number of cells lies between centres.
  VoxelMap even{MapOptions{}};
  testing::draw(even, {0, 0, 0}, {39, 5, 5}, [](const CellKey& k) {
    return k.y == 0 || k.y == 5 || k.z == 0 || k.z == 5 ? Cell::occupied : Cell::free;
  });
  const Path odd_path = plan_on_grid(map, {1.0, 0.7, 0.7}, {7.0, 0.7, 0.7}, kOptions);
  EXPECT_TRUE(odd_path.found()) << odd_path.reason;
  EXPECT_FALSE(plan_on_grid(even, {1.0, 0.6, 0.6}, {7.0, 0.6, 0.6}, kOptions).found());
  const Path raw = plan_on_grid_squeezing(even, {1.0, 0.6, 0.6}, {7.0, 0.6, 0.6}, kOptions);
  ASSERT_TRUE(raw.found()) << raw.reason;
  EXPECT_GE(min_clearance(Obstacles(even), refine_path(even, raw.points, kOptions)),
            kOptions.clearance_m - 1e-6);
}

TEST(Refine, DegeneratePathsPass) {
  const VoxelMap map = testing::random_map(1, {20, 20, 20}, 0.0);
  EXPECT_TRUE(refine_path(map, {}, kOptions).empty());
  const Vec3 p(2, 2, 2);
  EXPECT_EQ(refine_path(map, {p}, kOptions).size(), 1u);
  const std::vector<Vec3> same = refine_path(map, {p, p}, kOptions);
  EXPECT_EQ(same.front(), p);
  EXPECT_EQ(same.back(), p);
  EXPECT_EQ(path_length_m(same), 0.0);
}

TEST(Refine, KeepsTheWayOutOfATightStart) {
  VoxelMap map{MapOptions{}};
  testing::draw(map, {0, 0, 0}, {39, 14, 14},
                [](const CellKey& k) { return k.y == 0 ? Cell::occupied : Cell::free; });
  const Path raw = plan_on_grid(map, {2.0, 0.32, 1.5}, {7.0, 1.5, 1.5}, kOptions);
  ASSERT_TRUE(raw.found());
  const std::vector<Vec3> fine = refine_path(map, raw.points, kOptions);
  EXPECT_EQ(fine.front(), raw.points.front());
  EXPECT_EQ(fine.back(), raw.points.back());
  const Obstacles obstacles(map);
  double before = 0;
  std::size_t i = 0;
  for (; i < fine.size() && obstacles.distance(fine[i]) < kOptions.clearance_m; ++i) {
    EXPECT_GE(obstacles.distance(fine[i]), before - 1e-9);
    before = obstacles.distance(fine[i]);
  }
  EXPECT_EQ(first_blocked_segment(map, {fine.begin() + static_cast<std::ptrdiff_t>(i), fine.end()}, 0.45),
            -1);
}

}  // namespace
}  // namespace karst::core
