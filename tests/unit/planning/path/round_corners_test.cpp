#include "core_stack/planning/path/round_corners.h"

#include <gtest/gtest.h>

#include "core_stack/planning/path/path.h"
#include "core_stack/planning/search/grid_planner.h"
#include "core_stack/planning/trajectory/trajectory.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

FreeTiles tiles_of(const VoxelMap& map, const std::vector<Vec3>& points) {
  FreeTiles free(map.resolution_m());
  for (const Vec3& p : points) free.load_near(map, p, 2);
  return free;
}

/// From (1, 1, 2) along x to `corner_m`, then along y; 0.1 m apart.
std::vector<Vec3> right_angle(double corner_m) {
  std::vector<Vec3> points;
  for (double x = 1; x < corner_m - 0.01; x += 0.1) points.emplace_back(x, 1, 2);
  for (double y = 1; y < corner_m + 0.01; y += 0.1) points.emplace_back(corner_m, y, 2);
  return points;
}

double flown_in_s(const std::vector<Vec3>& points) {
  HeadingPlan heading;
  heading.along_path = false;
  return seconds(sample_trajectory(points, 0, 0, MotionLimits{}, heading).end());
}

TEST(RoundCorners, ACornerBecomesAnArcOfTheSameEnds) {
  VoxelMap hall{MapOptions{}};
  testing::draw(hall, {0, 0, 0}, {39, 39, 19}, [](const CellKey&) { return Cell::free; });
  const std::vector<Vec3> sharp = right_angle(5), round = round_corners(tiles_of(hall, sharp), 0.45, sharp);
  ASSERT_EQ(round.size(), sharp.size());
  EXPECT_EQ(round.front(), sharp.front());
  EXPECT_EQ(round.back(), sharp.back());
  double furthest_m = 0;
  for (std::size_t i = 0; i < round.size(); ++i)
    furthest_m = std::max(furthest_m, (round[i] - sharp[i]).norm());
  EXPECT_GT(furthest_m, 0.1);
  EXPECT_LT(furthest_m, 0.3);
  EXPECT_LT(flown_in_s(round), flown_in_s(sharp) - 0.1);
  EXPECT_LT(path_length_m(round), path_length_m(sharp));
}

TEST(RoundCorners, AStraightLineStays) {
  VoxelMap hall{MapOptions{}};
  testing::draw(hall, {0, 0, 0}, {39, 9, 19}, [](const CellKey&) { return Cell::free; });
  std::vector<Vec3> line;
  for (int i = 0; i < 50; ++i) line.emplace_back(1 + 0.1 * i, 1, 2);
  const std::vector<Vec3> round = round_corners(tiles_of(hall, line), 0.45, line);
  for (std::size_t i = 0; i < line.size(); ++i) EXPECT_LT((round[i] - line[i]).norm(), 1e-9);
}

TEST(RoundCorners, ACornerThatTouchesTheClearanceIsCutOnlyAsFarAsThatAllows) {
  // Rock fills the inner side of the corner, and leaves the path exactly its clearance there.
  VoxelMap map{MapOptions{}};
  testing::draw(map, {0, 0, 0}, {39, 39, 19},
                [](const CellKey& k) { return k.x < 22 && k.y > 7 ? Cell::occupied : Cell::free; });
  const std::vector<Vec3> sharp = right_angle(5);
  const FreeTiles free = tiles_of(map, sharp);
  const double clearance_m = 0.49;
  const std::vector<Vec3> round = round_corners(free, clearance_m, sharp);
  EXPECT_EQ(first_blocked_segment(map, sharp, clearance_m), -1);
  EXPECT_EQ(first_blocked_segment(map, round, clearance_m), -1);
}

TEST(RoundCorners, NoSegmentLosesItsClearanceInRandomMaps) {
  int rounded = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const VoxelMap map = testing::random_map(seed, {40, 30, 15}, 0.01);
    const Path path = plan_on_grid(map, {1, 1, 1.5}, {7, 5, 1.5}, kOptions);
    if (!path.found() || path.escape_points > 0) continue;
    std::vector<Vec3> points{path.points.front()};
    for (std::size_t i = 1; i < path.points.size(); ++i) {
      const Vec3 d = path.points[i] - path.points[i - 1];
      for (int k = 1; k <= 4; ++k) points.push_back(path.points[i - 1] + d * k / 4);
    }
    const double clearance_m = search_clearance_m(kOptions, map.resolution_m());
    if (first_blocked_segment(map, points, clearance_m) != -1) continue;  // it squeezes through
    const std::vector<Vec3> round = round_corners(tiles_of(map, points), clearance_m, points);
    EXPECT_EQ(first_blocked_segment(map, round, clearance_m), -1) << seed;
    rounded += round != points;
  }
  EXPECT_GE(rounded, 5);
}

TEST(RoundCorners, FewPointsStay) {
  VoxelMap hall{MapOptions{}};
  testing::draw(hall, {0, 0, 0}, {39, 39, 19}, [](const CellKey&) { return Cell::free; });
  const std::vector<std::vector<Vec3>> all{{}, {Vec3(1, 1, 1)}, {Vec3(1, 1, 1), Vec3(1, 2, 1)}};
  for (const std::vector<Vec3>& few : all) EXPECT_EQ(round_corners(tiles_of(hall, few), 0.45, few), few);
}

}  // namespace
}  // namespace karst::core
