#include "sdk/cave_drawing/wall_trace.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace karst::cave_drawing {
namespace {

double area_of(const std::vector<Line>& lines) {
  double sum = 0;
  for (const Line& l : lines) sum += signed_area(l);
  return sum;
}

TEST(WallTrace, TheAreaOfAllOutlinesIsTheNumberOfCells) {
  std::uint32_t state = 7;
  for (int round = 0; round < 50; ++round) {
    CellMask mask("test", -5, -5, 14, 9);
    for (int y = -5; y <= 9; ++y)
      for (int x = -5; x <= 14; ++x) {
        state = state * 1664525u + 1013904223u;
        mask.set(x, y, (state >> 24) % 3 != 0);
      }
    const std::vector<Line> lines = outlines_of(mask);
    EXPECT_DOUBLE_EQ(area_of(lines), static_cast<double>(mask.count()));
    for (const Line& l : lines) EXPECT_EQ(l.front(), l.back()) << "a ring";
  }
}

TEST(WallTrace, ARoomWithAPillarHasTwoRingsAndThePillarTurnsTheOtherWay) {
  CellMask mask("test", 0, 0, 9, 9);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x) mask.set(x, y, !(x >= 4 && x < 6 && y >= 3 && y < 7));
  const std::vector<Line> lines = outlines_of(mask);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_DOUBLE_EQ(signed_area(lines[0]), 100);
  EXPECT_DOUBLE_EQ(signed_area(lines[1]), -8);
}

TEST(WallTrace, CellsThatTouchAtACornerAreTwoRings) {
  CellMask mask("test", 0, 0, 1, 1);
  mask.set(0, 0), mask.set(1, 1);
  EXPECT_EQ(outlines_of(mask).size(), 2u);
}

TEST(WallTrace, SidesInARowAreOneOpenLine) {
  const std::vector<Line> lines = joined({side_of(2, 0, 0), side_of(0, 0, 0), side_of(1, 0, 0)});
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].front(), Point(0, 0));
  EXPECT_EQ(lines[0].back(), Point(3, 0));
}

}  // namespace
}  // namespace karst::cave_drawing
