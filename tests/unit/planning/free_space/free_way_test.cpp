#include "core_stack/planning/free_space/free_way.h"

#include <gtest/gtest.h>

namespace karst::core {
namespace {

constexpr std::size_t kNoLimit = 1'000'000;

/// Free from (0, 0) to (19, 19) in one layer, but for a wall along x = 10 with a gap at y = 19.
VoxelMap two_rooms() {
  VoxelMap map{MapOptions{}};
  for (std::int32_t y = 0; y < 20; ++y)
    for (std::int32_t x = 0; x < 20; ++x) map.assign({x, y, 0}, 1, x == 10 && y < 19 ? 2.0f : -2.0f);
  return map;
}

TEST(FreeWay, LeadsRoundAWallFromFaceToFaceAndIsShortest) {
  const VoxelMap map = two_rooms();
  const Vec3 from = map.center_of({8, 2, 0}), to = map.center_of({12, 2, 0});
  EXPECT_FALSE(sees(map, from, to));
  const auto way = free_way(map, from, to, 10, kNoLimit);
  ASSERT_TRUE(way);
  EXPECT_EQ(way->front(), from);
  EXPECT_EQ(way->back(), to);
  EXPECT_EQ(way->size(), 1u + 17 + 4 + 17);
  for (std::size_t i = 1; i < way->size(); ++i) EXPECT_NEAR(((*way)[i] - (*way)[i - 1]).norm(), 0.2, 1e-9);
}

TEST(FreeWay, IsNoneOutsideOfTheBoxAndAfterTooManyCells) {
  const VoxelMap map = two_rooms();
  const Vec3 from = map.center_of({8, 2, 0}), to = map.center_of({12, 2, 0});
  EXPECT_FALSE(free_way(map, from, to, 1, kNoLimit)) << "the gap is 3.4 m aside";
  EXPECT_FALSE(free_way(map, from, to, 10, 50));
}

TEST(FreeWay, TheNearestFreeCellIsWithinThreeCells) {
  const VoxelMap map = two_rooms();
  EXPECT_EQ(free_near(map, map.center_of({3, 3, 2})), map.center_of({3, 3, 0}));
  EXPECT_FALSE(free_near(map, map.center_of({3, 3, 9})));
}

}  // namespace
}  // namespace karst::core
