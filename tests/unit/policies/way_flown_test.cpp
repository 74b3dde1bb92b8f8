#include <gtest/gtest.h>

#include <karst/way_flown.h>

#include <cmath>
#include <random>

namespace {

TEST(WayFlown, IsInfinitelyFarBeforeTheFirstDecision) {
  EXPECT_EQ(karst::WayFlown{}.distance_m({1, 2, 3}), std::numeric_limits<double>::infinity());
}

TEST(WayFlown, DistanceIsThatToTheNearestOfManyPointsAlongIt) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> step(-2, 2);
  for (int trial = 0; trial < 50; ++trial) {
    karst::WayFlown way;
    std::vector<karst::Vec3> corners{{0, 0, 0}};
    way.note(corners.back());
    for (int i = 0; i < 20; ++i) {
      corners.push_back(corners.back() + karst::Vec3(step(random), step(random), step(random)));
      way.note(corners.back());
      way.note(corners.back());  // it stood
    }
    const karst::Vec3 p(3 * step(random), 3 * step(random), 3 * step(random));
    double least_m = karst::distance(p, corners[0]);
    for (std::size_t i = 1; i < corners.size(); ++i)
      for (double t = 0; t <= 1; t += 0.001)
        least_m = std::min(least_m, karst::distance(p, corners[i - 1] + t * (corners[i] - corners[i - 1])));
    // Steps shorter than 0.3 m are left out, and the line cuts what lay between.
    EXPECT_NEAR(way.distance_m(p), least_m, 0.3);
  }
}

}  // namespace
