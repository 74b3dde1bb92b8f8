#include "sdk/cave_drawing/smooth_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sdk/cave_drawing/wall_trace.h"

namespace karst::cave_drawing {
namespace {

/// The steps of cells along a disc.
Line disc(double radius) {
  const int r = static_cast<int>(radius) + 2;
  CellMask mask("test", -r, -r, r, r);
  for (int y = -r; y <= r; ++y)
    for (int x = -r; x <= r; ++x) mask.set(x, y, std::hypot(x + 0.5, y + 0.5) <= radius);
  return outlines_of(mask).front();
}

double distance_to(const Line& line, const Point& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Point d = line[i] - line[i - 1];
    const double t = std::clamp((p - line[i - 1]).dot(d) / d.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (p - line[i - 1] - t * d).norm());
  }
  return least;
}

TEST(SmoothLine, NoPointLeavesTheWallByMoreThanHalfACell) {
  const Line steps = disc(9.3);
  for (const Point& p : smoothed(steps)) EXPECT_LE(distance_to(steps, p), 0.5 + 1e-9);
}

TEST(SmoothLine, ADiscsOutlineIsAsLongAsACircleAndNotAsItsSteps) {
  const Line line = smoothed(disc(9.3));
  double length = 0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  const double circle = 2 * 3.14159265 * 9.3;
  EXPECT_NEAR(length, circle, 0.04 * circle) << "the steps are 27 % longer";
  EXPECT_NEAR(signed_area(line), 3.14159265 * 9.3 * 9.3, 0.03 * 272);
  EXPECT_EQ(line.front(), line.back());
}

TEST(SmoothLine, TheEndsOfAnOpenLineStay) {
  const Line steps{{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}};
  EXPECT_EQ(smoothed(steps).front(), Point(0, 0));
  EXPECT_EQ(smoothed(steps).back(), Point(2, 2));
}

TEST(SmoothLine, SimplifiedLinesStayWithinTheirDistanceAndLoseWhatIsStraight) {
  const Line straight{{0, 0}, {1, 0}, {2, 0.01}, {3, 0}};
  EXPECT_EQ(simplified(straight, 0.1).size(), 2u);
  const Line line = smoothed(disc(9.3)), fewer = simplified(line, 0.2);
  EXPECT_LT(fewer.size(), line.size() / 2);
  for (const Point& p : line) EXPECT_LE(distance_to(fewer, p), 0.2 + 1e-9);
}

}  // namespace
}  // namespace karst::cave_drawing
