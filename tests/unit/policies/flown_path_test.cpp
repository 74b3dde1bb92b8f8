#include <gtest/gtest.h>

#include <karst/flown_path.h>

#include <cmath>
#include <random>

namespace {

TEST(FlownPath, IsInfinitelyFarBeforeTheFirstDecision) {
  EXPECT_EQ(karst::FlownPath{}.distance_m({1, 2, 3}), std::numeric_limits<double>::infinity());
}

TEST(FlownPath, DistanceIsThatToTheNearestOfManyPointsAlongIt) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> step(-2, 2);
  for (int trial = 0; trial < 50; ++trial) {
    karst::FlownPath path;
    std::vector<karst::Vec3> corners{{0, 0, 0}};
    path.note(corners.back());
    for (int i = 0; i < 20; ++i) {
      corners.push_back(corners.back() + karst::Vec3(step(random), step(random), step(random)));
      path.note(corners.back());
      path.note(corners.back());  // it stood
    }
    const karst::Vec3 p(3 * step(random), 3 * step(random), 3 * step(random));
    double min_m = karst::distance(p, corners[0]);
    for (std::size_t i = 1; i < corners.size(); ++i)
      for (double t = 0; t <= 1; t += 0.001)
        min_m = std::min(min_m, karst::distance(p, corners[i - 1] + t * (corners[i] - corners[i - 1])));
    // Steps shorter than 0.3 m are left out, and the line cuts what lay between.
    EXPECT_NEAR(path.distance_m(p), min_m, 0.3);
  }
}

}  // namespace
