#include "core_stack/mapping/obstacles/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core_stack/common/random.h"
#include "core_stack/mapping/obstacles/plane_normal.h"

namespace karst::core {
namespace {

std::vector<Vec3f> random_points(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3f> points;
  for (std::size_t i = 0; i < count; ++i) {
    const auto coordinate = [&] { return static_cast<float>(random.uniform(-5, 5)); };
    const float x = coordinate(), y = coordinate(), z = coordinate();
    points.emplace_back(x, y, z);
  }
  return points;
}

TEST(PointTree, FindsTheNearestFewAsBruteForceDoes) {
  const PointTree tree(random_points(700, 5));
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const Vec3 p(random.uniform(-7, 7), random.uniform(-7, 7), random.uniform(-7, 7));
    std::vector<std::uint32_t> order(tree.points().size());
    std::iota(order.begin(), order.end(), 0u);
    const auto distance = [&](std::uint32_t k) { return (tree.points()[k].cast<double>() - p).norm(); };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); });
    for (const std::size_t count : {std::size_t{1}, std::size_t{7}, std::size_t{40}}) {
      const std::vector<std::uint32_t> few = tree.nearest_few(p, count);
      ASSERT_EQ(few.size(), count);
      for (std::size_t k = 0; k < count; ++k) EXPECT_NEAR(distance(few[k]), distance(order[k]), 1e-5);
    }
  }
}

TEST(PointTree, GivesNoMoreThanThereAre) {
  const PointTree three(random_points(3, 1)), none({});
  EXPECT_EQ(three.nearest_few(Vec3(0, 0, 0), 10).size(), 3u);
  EXPECT_TRUE(three.nearest_few(Vec3(0, 0, 0), 0).empty());
  EXPECT_TRUE(none.nearest_few(Vec3(0, 0, 0), 10).empty());
  EXPECT_TRUE(three.nearest_few(Vec3(0, std::numeric_limits<double>::quiet_NaN(), 0), 2).empty());
}

TEST(PlaneNormal, IsAcrossThePlaneOfTheChosenPoints) {
  Random random(3);
  const Vec3 across = Vec3(1, -2, 3).normalized(), u = across.unitOrthogonal(), v = across.cross(u);
  std::vector<Vec3f> points;
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 0; i < 60; ++i) {
    const bool in_plane = i % 3 != 0;  // the others are anywhere
    const Vec3 p = random.uniform(-1, 1) * u + random.uniform(-1, 1) * v +
                   (in_plane ? 0 : random.uniform(-9, 9)) * across;
    points.push_back((Vec3(4, 5, 6) + p).cast<float>());
    if (in_plane) chosen.push_back(i);
  }
  EXPECT_NEAR(std::abs(plane_normal(points, chosen, points[1]).cast<double>().dot(across)), 1, 1e-5);
}

}  // namespace
}  // namespace karst::core
