#include "sdk/cave_drawing/projection.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/unit/cave_drawing/box_maps.h"
#include "tests/unit/cave_drawing/drawn_lines.h"

namespace karst::cave_drawing {
namespace {

constexpr double kRightAngle = std::numbers::pi / 2;

TEST(Projection, TheLongestBearingIsAlongTheRow) {
  EXPECT_NEAR(longest_bearing({{0, 0}, {10, 10}, {4, 5}}), kRightAngle / 2, 0.01);
  EXPECT_NEAR(longest_bearing({{0, 0}, {10, -10}}), 1.5 * kRightAngle, 0.01);
  EXPECT_DOUBLE_EQ(longest_bearing({{0, 0}, {0, 10}}), 0.0) << "north";
}

TEST(Projection, ARoomFromTheSideIsAsLongAndAsHighAsItIs) {
  const FreeRuns free = free_runs(test::map_of_boxes({{{0, 0, -10}, {49, 29, 4}}}), "map");
  const core::Vec3 entrance(5, 3, 0);
  for (const auto& [bearing, length_m] : {std::pair{kRightAngle, 10.0}, std::pair{0.0, 6.0}}) {
    const Drawing profile = projected_profile(free, entrance, bearing, "map");
    EXPECT_NEAR(test::area_m2(profile), length_m * 3.0, 0.2) << bearing;
    EXPECT_NEAR(test::span_of(profile.walls, 0).length(), length_m, 0.2);
    EXPECT_NEAR(test::span_of(profile.walls, 0).low, -0.5 * length_m, 0.2) << "from the entrance";
    EXPECT_NEAR(test::span_of(profile.walls, 1).low, -2.0, 0.2);
  }
  const Drawing diagonal = projected_profile(free, entrance, kRightAngle / 2, "map");
  EXPECT_NEAR(test::span_of(diagonal.walls, 0).length(), 16 / std::numbers::sqrt2, 0.5);
  ASSERT_EQ(diagonal.spaces.size(), 1u);
  EXPECT_EQ(diagonal.spaces[0].size(), 1u) << "no gaps between the cells";
}

}  // namespace
}  // namespace karst::cave_drawing
