// Depth against lengths known from the drawing, and against a plain Floyd-Warshall.
#include "sdk/evaluation/metrics/depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core_stack/common/random.h"

namespace karst::evaluation {
namespace {

using core::Vec3;

/// Points 5 cm apart along the polyline.
std::vector<Vec3> along(const std::vector<Vec3>& corners) {
  std::vector<Vec3> path{corners.front()};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const int steps = static_cast<int>(std::ceil((corners[i] - corners[i - 1]).norm() / 0.05));
    for (int k = 1; k <= steps; ++k)
      path.push_back(corners[i - 1] + (corners[i] - corners[i - 1]) * k / steps);
  }
  return path;
}

TEST(Depth, OfThereAndBackIsTheWayThere) {
  EXPECT_NEAR(depth_along_path(along({{0, 0, 0}, {30, 0, 0}, {30, 0, -12}, {30, 0, 0}, {0, 0, 0}})), 42, 0.6);
}

TEST(Depth, GoesAroundTheCornersThatTheVehicleWentAround) {
  // A hairpin two metres wide: the far end is 2 m from the start in a straight line.
  EXPECT_NEAR(depth_along_path(along({{0, 0, 0}, {20, 0, 0}, {20, 2, 0}, {0, 2, 0}})), 42, 0.8);
}

TEST(Depth, LeavesDetoursOut) {
  // A side trip of 10 m and back before it goes on to 20 m.
  EXPECT_NEAR(depth_along_path(along({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {10, 0, 0}, {20, 0, 0}})), 20, 0.5);
}

TEST(Depth, OfALoopIsItsFarSideFromEitherSide) {
  std::vector<Vec3> circle;
  for (int i = 0; i <= 2000; ++i) {
    const double a = 2 * std::numbers::pi * i / 2000;
    circle.push_back(10 * Vec3(std::cos(a), std::sin(a), 0));
  }
  EXPECT_NEAR(depth_along_path(circle), 10 * std::numbers::pi, 0.5);
}

TEST(Depth, EqualsTheLongestShortestWayOfARandomFlight) {
  core::Random random(4);
  std::vector<Vec3> path{Vec3::Zero()};  // farther apart than 0.25 m, so that none is left out
  for (int i = 0; i < 120; ++i)
    path.push_back(path.back() + 0.3 * Vec3(random.normal(), random.normal(), random.normal()).normalized());
  const std::size_t n = path.size();
  std::vector<std::vector<double>> d(n, std::vector<double>(n, 1e9));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k) {
      const double length = (path[i] - path[k]).norm();
      if (length <= 0.6 || std::max(i, k) - std::min(i, k) <= 1) d[i][k] = length;
    }
  for (std::size_t via = 0; via < n; ++via)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < n; ++k) d[i][k] = std::min(d[i][k], d[i][via] + d[via][k]);
  double expected = 0;
  for (std::size_t i = 0; i < n; ++i) expected = std::max(expected, d[0][i]);
  EXPECT_NEAR(depth_along_path(path), expected, 1e-9);
}

TEST(Depth, OfNothingIsNone) {
  EXPECT_EQ(depth_along_path({}), 0);
  EXPECT_EQ(depth_along_path({Vec3(1, 2, 3)}), 0);
  EXPECT_EQ(vertical_reach({}), 0);
}

TEST(VerticalReach, IsTheGreatestHeightAboveOrBelowTheStart) {
  EXPECT_EQ(vertical_reach({Vec3(0, 0, 5), Vec3(9, 0, 8), Vec3(0, 0, -2), Vec3(0, 0, 5)}), 7);
  EXPECT_EQ(vertical_reach({Vec3(0, 0, 5), Vec3(9, 0, 14)}), 9);
}

}  // namespace
}  // namespace karst::evaluation
