#include "core_stack/planning/passages/cross_section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/planning/passages/drawn_caves.h"

namespace karst::core {
namespace {

using testing::box;
using testing::map_of;

VoxelMap corridor() { return map_of(box({0, 0, 0}, {40, 3, 2}), {-1, -1, -1}, {41, 4, 3}); }

TEST(FreeReach, EndsWhereTheFreeCellsDo) {
  const VoxelMap map = corridor();
  const Vec3 p(20.1, 0.5, 1.7);
  EXPECT_NEAR(free_reach_m(map, p, Vec3::UnitY()), 2.5, 1e-9);
  EXPECT_NEAR(free_reach_m(map, p, -Vec3::UnitY()), 0.5, 1e-9);
  EXPECT_NEAR(free_reach_m(map, p, Vec3::UnitX()), 19.9, 1e-9);
  EXPECT_NEAR(free_reach_m(map, p, Vec3(1, 1, 0).normalized()), 2.5 * std::sqrt(2.0), 1e-9);
  const VoxelMap open = map_of(box({0, 0, 0}, {200, 3, 2}), {0, 0, 0}, {199.9, 2.9, 1.9});
  EXPECT_EQ(free_reach_m(open, {10.1, 1.5, 1}, Vec3::UnitX()), kMostReach_m);
  EXPECT_NEAR(free_reach_m(open, {10.1, 1.5, 1.1}, Vec3::UnitZ()), 0.9, 1e-9) << "unknown beyond";
}

TEST(FreeReach, PassesASingleUnknownCell) {
  VoxelMap map{MapOptions{}};
  for (const std::int32_t x : {0, 1, 2, 4, 5, 8, 9}) map.assign({x, 0, 0}, 1, -2.0f);
  const Vec3 p(0.1, 0.1, 0.1);
  EXPECT_NEAR(free_reach_m(map, p, Vec3::UnitX()), 1.1, 1e-9) << "over 3, up to 6 and 7";
  map.assign({3, 0, 0}, 1, 2.0f);
  EXPECT_NEAR(free_reach_m(map, p, Vec3::UnitX()), 0.5, 1e-9) << "3 is rock";
  VoxelMap behind{MapOptions{}};
  for (const std::int32_t x : {0, 1}) behind.assign({x, 0, 0}, 1, -2.0f);
  behind.assign({3, 0, 0}, 1, 2.0f);
  EXPECT_NEAR(free_reach_m(behind, p, Vec3::UnitX()), 0.3, 1e-9) << "unknown, then rock";
}

TEST(CrossSection, OfACorridorIsItsWidthAndHeightAndItsMiddle) {
  const VoxelMap map = corridor();
  const CrossSection s = cross_section(map, {20.1, 0.5, 1.7}, 2.0);
  EXPECT_NEAR(s.width_m, 3, 1e-9);
  EXPECT_NEAR(s.height_m, 2, 1e-9);
  EXPECT_NEAR((s.center - Vec3(20.1, 1.5, 1.0)).norm(), 0, 1e-9);
  const CrossSection near = cross_section(map, {20.1, 0.5, 1.7}, 0.1);
  EXPECT_NEAR((near.center - Vec3(20.1, 0.6, 1.6)).norm(), 0, 1e-9) << "moved by a tenth of a metre";
  EXPECT_NEAR(near.width_m, 3, 1e-9);
}

TEST(CrossSection, OfATubeInAnyDirectionIsItsDiameter) {
  for (const double heading_deg : {0.0, 20.0, 45.0, 70.0, 90.0}) {
    const double a = heading_deg * std::numbers::pi / 180;
    const Vec3 d(std::cos(a), std::sin(a), 0);
    const VoxelMap map = map_of(testing::tube({-15 * d, 15 * d}, 2), {-18, -18, -3}, {18, 18, 3});
    const CrossSection s = cross_section(map, map.center_of(map.key_of(0.3 * d)), 0.8);
    EXPECT_NEAR(s.width_m, 4, 0.45) << heading_deg;  // two cells
    EXPECT_NEAR(s.height_m, 4, 0.45) << heading_deg;
  }
}

}  // namespace
}  // namespace karst::core
