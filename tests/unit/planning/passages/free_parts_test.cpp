#include "core_stack/planning/passages/free_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/planning/passages/drawn_caves.h"

namespace karst::core {
namespace {

using testing::box;
using testing::Depth;
using testing::either;
using testing::map_of;
using testing::parts_of;

const Vec3 kLow(-1, -1, -1), kHigh(9, 5, 4);

double farthest_x(const FreeParts& space) {
  double x = -1e9;
  for (const FreePart& p : space.parts) x = std::max(x, p.middle.x());
  return x;
}

TEST(PassageGrid, CellsAreMergedAndCubesSizedByTheResolution) {
  const auto expect = [](double resolution_m, double cell_m, int cube_cells, int room) {
    const PassageGrid g = passage_grid(resolution_m);
    EXPECT_NEAR(g.cell_m, cell_m, 1e-12) << resolution_m;
    EXPECT_EQ(g.cube_cells(), cube_cells) << resolution_m;
    EXPECT_EQ(g.room, room) << resolution_m;
  };
  expect(0.02, 0.16, 4, 2);
  expect(0.05, 0.2, 4, 2);
  expect(0.1, 0.2, 4, 2);
  expect(0.2, 0.2, 4, 2);
  expect(0.25, 0.25, 4, 1);
  expect(0.3, 0.3, 2, 1);
  expect(0.5, 0.5, 2, 0);
  expect(1.0, 1.0, 1, 0);
  expect(2.0, 2.0, 1, 0);
}

TEST(FreeParts, OfARoomAreItsCubesJoinedAcrossTheirFaces) {
  // 20 cells of 0.2 m along each axis: 5 cubes of 4. The side towards +x is not known.
  const VoxelMap map =
      map_of(box({0, 0, 0}, {4, 4, 4}), kLow, {5, 5, 5}, 0.2, [](const Vec3& p) { return p.x() < 4; });
  const FreeParts space = parts_of(map, {2, 2, 2});
  ASSERT_EQ(space.parts.size(), 5u * 5 * 5);
  EXPECT_EQ(space.links.size(), 2u * 3 * 4 * 5 * 5);
  std::size_t inside = 0, free = 0, frontier = 0;
  for (const FreePart& p : space.parts) {
    inside += p.is_inside;
    free += p.free_cells;
    frontier += p.frontier_cells;
  }
  EXPECT_EQ(inside, 3u * 3 * 3);
  EXPECT_EQ(free, map.free_cells()) << "those near the walls count to the part beside them";
  EXPECT_EQ(frontier, 20u * 20);
  EXPECT_LT((space.parts[space.start].middle - Vec3(2, 2, 2)).norm(), 0.5);
}

TEST(FreeParts, EndAtAWallOfOneCell) {
  for (const double resolution_m : {0.1, 0.2, 0.25, 0.5, 1.0}) {
    VoxelMap map = map_of(box({0, 0, 0}, {8, 4, 3}), kLow, kHigh, resolution_m);
    EXPECT_GT(farthest_x(parts_of(map, {1, 2, 1.5})), 6) << resolution_m;
    const CellKey wall = map.key_of({4.05, 0, 0});
    for (std::int32_t y = 0; y * resolution_m < 4; ++y)
      for (std::int32_t z = 0; z * resolution_m < 3; ++z) map.assign({wall.x, y, z}, 1, 2.0f);
    EXPECT_LT(farthest_x(parts_of(map, {1, 2, 1.5})), 4) << resolution_m;
    EXPECT_GT(farthest_x(parts_of(map, {7, 2, 1.5})), 6) << resolution_m;
  }
}

TEST(FreeParts, DoNotLeadThroughHolesAndCracks) {
  VoxelMap map = map_of(box({0, 0, 0}, {8, 4, 3}), kLow, kHigh);
  for (std::int32_t y = 0; y < 20; ++y)
    for (std::int32_t z = 0; z < 15; ++z)
      if (y != 3 && z != 9) map.assign({20, y, z}, 1, 2.0f);  // a crack upwards, and one across
  EXPECT_LT(farthest_x(parts_of(map, {1, 2, 1.5})), 4);
  const VoxelMap door = map_of(either(either(box({0, 0, 0}, {4, 4, 3}), box({4.4, 0, 0}, {8, 4, 3})),
                                      box({3, 1.4, 0.4}, {5, 2.6, 1.6})),
                               kLow, kHigh);
  EXPECT_GT(farthest_x(parts_of(door, {1, 2, 1.5})), 6) << "a door of 1.2 m by 1.2 m";
}

TEST(FreeParts, AreTheSameWithLonelyCells) {
  const VoxelMap map = map_of(box({0, 0, 0}, {8, 4, 3}), kLow, kHigh);
  VoxelMap dusty{MapOptions{}};
  map.for_each_known([&](const CellKey& k, Cell c, float log_odds) {
    const bool lonely = k.x % 3 == 1 && k.y % 3 == 1 && k.z % 3 == 1 && c == Cell::free;
    if (lonely && k.x % 2 == 0) return;  // a gap
    dusty.assign(k, 1, lonely ? 2.0f : log_odds);
  });
  const FreeParts clean = parts_of(map, {1, 2, 1.5}), space = parts_of(dusty, {1, 2, 1.5});
  ASSERT_EQ(space.parts.size(), clean.parts.size());
  EXPECT_EQ(space.links.size(), clean.links.size());
}

TEST(FreeParts, AreNoneFarFromTheStart) {
  const VoxelMap map = map_of(box({0, 0, 0}, {8, 4, 3}), kLow, kHigh);
  EXPECT_TRUE(parts_of(map, {20, 2, 1.5}).parts.empty());
  EXPECT_FALSE(parts_of(map, {11, 2, 1.5}).parts.empty()) << "within 5 m";
  EXPECT_TRUE(parts_of(VoxelMap{MapOptions{}}, {0, 0, 0}).parts.empty());
  EXPECT_TRUE(parts_of(map, {std::nan(""), 0, 0}).parts.empty());
}

TEST(FreeParts, AreConnectedThroughATightPlaceIfAVehicleFlewThere) {
  const VoxelMap map = map_of(either(either(box({0, 0, 0}, {8, 4, 3}), box({12, 0, 0}, {20, 4, 3})),
                                     box({7, 1.7, 1.2}, {13, 2.3, 1.8})),
                              {-1, -1, -1}, {21, 5, 4});
  const auto most_x = [](const FreeParts& space) {
    double most = -1e9;
    for (const FreePart& part : space.parts) most = std::max(most, part.middle.x());
    return most;
  };
  EXPECT_LT(most_x(parts_of(map, {1, 2, 1.5})), 9);
  std::vector<Vec3> flown;
  for (double x = 1; x < 19; x += 0.5) flown.emplace_back(x, 2, 1.5);
  WorkBudget work(kMaxPassageWork);
  EXPECT_GT(most_x(free_parts_around(map, {1, 2, 1.5}, work, flown).value()), 18);
  const std::vector<Vec3> jump = {{1, 2, 1.5}, {19, 2, 1.5}};
  WorkBudget again(kMaxPassageWork);
  EXPECT_LT(most_x(free_parts_around(map, {1, 2, 1.5}, again, jump).value()), 9)
      << "where the estimate jumped, nothing flew";
}

TEST(FreeParts, BeginWhereThereIsRoomAlsoIfTheFlownPathBreaksOffAtTheLaunchSite) {
  const VoxelMap map = map_of(box({0, 0, 0}, {8, 4, 3}), kLow, kHigh);
  const std::vector<Vec3> flown = {{1, 2, 0.1}, {1, 2, 0.2}, {5, 2, 1.5}};  // then the estimate jumps
  WorkBudget work(kMaxPassageWork);
  const FreeParts space = free_parts_around(map, {1, 2, 0.1}, work, flown).value();
  EXPECT_GE(space.parts.size(), parts_of(map, {1, 2, 1.5}).parts.size());
}

TEST(FreeParts, EndWithTheWorkAllowed) {
  const VoxelMap map = map_of(box({0, 0, 0}, {8, 4, 3}), kLow, kHigh);
  const std::uint64_t known = map.free_cells() + map.occupied_cells();
  const auto answered = [&](std::uint64_t steps) {
    WorkBudget work(steps);
    return free_parts_around(map, {1, 2, 1.5}, work).has_value();
  };
  EXPECT_FALSE(answered(known - 1));
  EXPECT_FALSE(answered(known)) << "the parts are work, too";
  EXPECT_TRUE(answered(known + kPartWork * 10 * 5 * 4));
}

TEST(FreeParts, NearestIsThatOfThePointsCubeOrOneNearIt) {
  const FreeParts space = parts_of(map_of(box({0, 0, 0}, {8, 4, 3}), kLow, kHigh), {1, 2, 1.5});
  for (std::uint32_t i = 0; i < space.parts.size(); ++i) EXPECT_EQ(space.nearest(space.parts[i].middle), i);
  EXPECT_NE(space.nearest({4, 2, -0.5}), kNoPart) << "under the floor";
  EXPECT_EQ(space.nearest({4, 2, -5}), kNoPart);
  EXPECT_EQ(space.nearest({std::nan(""), 2, 1}), kNoPart);
  EXPECT_EQ(space.nearest({1e300, 2, 1}), kNoPart);
  EXPECT_EQ(FreeParts{}.nearest({0, 0, 0}), kNoPart);
}

}  // namespace
}  // namespace karst::core
