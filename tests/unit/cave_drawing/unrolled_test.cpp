#include "sdk/cave_drawing/unrolled.h"

#include <gtest/gtest.h>

#include "tests/unit/cave_drawing/box_maps.h"
#include "tests/unit/cave_drawing/drawn_lines.h"

namespace karst::cave_drawing {
namespace {

using test::map_of_boxes;

UnrolledProfile unrolled(const core::VoxelMap& map, const core::Vec3& start) {
  return unrolled_profile(map, passage_lines(map, start, "map"), start.z(), "map");
}

TEST(Unrolled, AStraightTunnelIsAsLongAsItIs) {
  const core::VoxelMap map = map_of_boxes({{{0, 0, 0}, {199, 14, 14}}});  // 40 m by 3 m by 3 m
  const UnrolledProfile profile = unrolled(map, {1.5, 1.5, 1.5});
  EXPECT_NEAR(profile.length_m, 40, 0.6);
  EXPECT_NEAR(test::span_of(profile.drawing.walls, 0).length(), 40, 0.6);
  EXPECT_NEAR(test::span_of(profile.drawing.walls, 1).length(), 3, 0.2);
  EXPECT_NEAR(test::span_of(profile.drawing.walls, 1).low, -1.5, 0.2) << "the floor, from the entrance";
  EXPECT_NEAR(test::area_m2(profile.drawing), 120, 4);
}

TEST(Unrolled, AnLShapedTunnelIsUnrolled) {
  // 30 m east, then 30 m north: 40 m from corner to corner, 57 m along its middle.
  const core::VoxelMap map = map_of_boxes({{{0, 0, 0}, {149, 14, 14}}, {{135, 0, 0}, {149, 149, 14}}});
  const UnrolledProfile profile = unrolled(map, {1.5, 1.5, 1.5});
  EXPECT_NEAR(test::span_of(profile.drawing.walls, 0).length(), 57, 3);
  EXPECT_NEAR(test::span_of(profile.drawing.walls, 1).length(), 3, 0.4);
}

TEST(Unrolled, AShaftIsAsWideAndAsDeepAsItIs) {
  // 20 m of passage, then 20 m down.
  const core::VoxelMap map = map_of_boxes({{{0, 0, 0}, {99, 14, 14}}, {{85, 0, -100}, {99, 14, 14}}});
  const UnrolledProfile profile = unrolled(map, {1.5, 1.5, 1.5});
  EXPECT_NEAR(test::span_of(profile.drawing.walls, 1).length(), 23, 1);
  EXPECT_NEAR(test::area_m2(profile.drawing), 20 * 3 + 20 * 3, 25);
}

TEST(Unrolled, SidePassagesDoNotCoverOneAnother) {
  // A cross: three ways from the middle beside the one to the entrance, all at one height.
  const core::VoxelMap map = map_of_boxes({{{0, 0, 0}, {249, 14, 14}}, {{120, -150, 0}, {134, 150, 14}}});
  const UnrolledProfile profile = unrolled(map, {1.5, 1.5, 1.5});
  const double cave_m2 = (50 + 2 * 28.7) * 3;
  EXPECT_GT(test::area_m2(profile.drawing), 0.85 * cave_m2);
  EXPECT_FALSE(profile.drawing.links.empty());
  EXPECT_EQ(test::count_of(profile.drawing, Mark::Kind::joint),
            2 * static_cast<long>(profile.drawing.links.size()));
}

TEST(Unrolled, WhereNoVehicleHasRoomNothingIsDrawn) {
  const core::VoxelMap map = map_of_boxes({{{0, 0, 0}, {50, 1, 1}}});
  EXPECT_TRUE(unrolled(map, {0.1, 0.1, 0.1}).drawing.spaces.empty());
}

}  // namespace
}  // namespace karst::cave_drawing
