#include "sdk/cave_drawing/map_plan.h"

#include <gtest/gtest.h>

#include "tests/unit/cave_drawing/box_maps.h"
#include "tests/unit/cave_drawing/drawn_lines.h"

namespace karst::cave_drawing {
namespace {

using test::map_of_boxes;

TEST(MapPlan, ARoomCoversItsCellsAndItsOutlineTheirAreaButForRoundedCorners) {
  const FreeRuns free = free_runs(map_of_boxes({{{0, 0, 0}, {49, 29, 9}}}), "map");
  EXPECT_EQ(mask_from_above(free, "map").count(), 50u * 30u);
  for (const Column& c : free.columns) {
    ASSERT_EQ(c.runs.size(), 1u);
    EXPECT_EQ(c.runs[0].high - c.runs[0].low + 1, 10);
  }
  const Drawing plan = plan_of(free, "map");
  EXPECT_NEAR(test::area_m2(plan), 50 * 30 * 0.04, 0.3);
  EXPECT_NEAR(test::span_of(plan.walls, 0).length(), 10.0, 0.2);
  EXPECT_NEAR(test::span_of(plan.walls, 1).length(), 6.0, 0.2);
  EXPECT_TRUE(plan.hidden_walls.empty());
}

TEST(MapPlan, APillarIsAHole) {
  const FreeRuns free = free_runs(map_of_boxes({{{0, 0, 0}, {39, 9, 9}},
                                                {{0, 20, 0}, {39, 29, 9}},
                                                {{0, 10, 0}, {9, 19, 9}},
                                                {{30, 10, 0}, {39, 19, 9}}}),
                                  "map");
  const Drawing plan = plan_of(free, "map");
  ASSERT_EQ(plan.spaces.size(), 1u);
  EXPECT_EQ(plan.spaces[0].size(), 2u);
  EXPECT_NEAR(test::area_m2(plan), (40 * 30 - 20 * 10) * 0.04, 0.6);
}

TEST(MapPlan, APassageThatCrossesAboveAnotherKeepsItsWallsAndHidesThoseBelow) {
  // The lower one along x, the upper one along y above it; joined by a shaft at the end.
  const FreeRuns free = free_runs(map_of_boxes({{{0, 0, 0}, {99, 19, 9}},
                                                {{40, -60, 20}, {59, 59, 29}},
                                                {{60, 50, 20}, {119, 59, 29}},
                                                {{100, 0, 0}, {119, 59, 9}},
                                                {{100, 50, 0}, {119, 59, 29}}}),
                                  "map");
  const Drawing plan = plan_of(free, "map");
  ASSERT_FALSE(plan.hidden_walls.empty());
  const test::Span along = test::span_of(plan.hidden_walls, 0), across = test::span_of(plan.hidden_walls, 1);
  EXPECT_NEAR(along.low, 8.0, 0.3) << "the hidden part of the lower passage";
  EXPECT_NEAR(across.low, 0.0, 0.3);
  double upper_m = 0;  // of walls across the lower passage, at the sides of the upper one
  for (const Line& wall : plan.walls)
    if (wall.front() != wall.back())
      for (std::size_t i = 1; i < wall.size(); ++i) {
        const Point middle = 0.5 * (wall[i] + wall[i - 1]);
        if (middle.y() > 0 && middle.y() < 4 && middle.x() > 7 && middle.x() < 13)
          upper_m += (wall[i] - wall[i - 1]).norm();
      }
  EXPECT_NEAR(upper_m, 8, 0.8) << "two walls of four metres";
}

TEST(MapPlan, RockOfHalfAMetrePartsTwoStoreysAndThinnerRockDoesNot) {
  for (const auto& [cells, runs] : {std::pair{1, 1u}, std::pair{2, 2u}}) {  // of 0.25 m
    core::MapOptions options;
    options.resolution_m = 0.25;
    core::VoxelMap map(options);
    for (std::int32_t z = 0; z < 10; ++z)  // a shaft with a bridge of rock in one of its two columns
      for (std::int32_t x = 0; x < 2; ++x)
        map.assign({x, 0, z}, 1, x == 0 && z >= 4 && z < 4 + cells ? 2.0f : -2.0f);
    const FreeRuns free = free_runs(map, "map");
    ASSERT_EQ(free.columns.size(), 2u);
    EXPECT_EQ(free.columns[0].runs.size(), runs) << cells;
  }
}

TEST(MapPlan, PiecesApartFromTheCaveAreLeftOut) {
  const FreeRuns free = free_runs(map_of_boxes({{{0, 0, 0}, {49, 29, 9}}, {{90, 0, 0}, {99, 9, 9}}}), "map");
  EXPECT_EQ(mask_from_above(free, "map").count(), 1500u);
}

TEST(MapPlan, AMapWithoutAFreeCellIsRefused) {
  const core::VoxelMap empty{core::MapOptions{}};
  EXPECT_NE(test::refusal_by([&] { free_runs(empty, "a.bt"); }).find("a.bt: the map has no free cell"),
            std::string::npos);
}

}  // namespace
}  // namespace karst::cave_drawing
