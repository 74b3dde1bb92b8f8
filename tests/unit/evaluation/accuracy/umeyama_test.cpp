// Against Eigen's own Umeyama, and against similarities that were planted.
#include "sdk/evaluation/accuracy/umeyama.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core_stack/common/random.h"

namespace karst::evaluation {
namespace {

using core::Quat;
using core::Random;
using core::Vec3;

Vec3 random_point(Random& r, double size) {
  return {r.uniform(-size, size), r.uniform(-size, size), r.uniform(-size, size)};
}
Quat random_turn(Random& r) { return Quat(r.normal(), r.normal(), r.normal(), r.normal()).normalized(); }

TEST(Umeyama, FindsWhatEigenFindsOnNoisyPoints) {
  Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const int n = 3 + trial % 40;
    const Similarity planted{random.uniform(0.5, 2), {random_point(random, 50), random_turn(random)}};
    std::vector<Vec3> from, to;
    Eigen::Matrix3Xd a(3, n), b(3, n);
    for (int i = 0; i < n; ++i) {
      from.push_back(random_point(random, 10));
      to.push_back(planted * from.back() + random_point(random, 0.5));
      a.col(i) = from.back(), b.col(i) = to.back();
    }
    for (const bool scale : {false, true}) {
      const auto found = umeyama(from, to, scale);
      ASSERT_TRUE(found);
      const Eigen::Matrix4d expected = Eigen::umeyama(a, b, scale);
      for (const Vec3& p : from)
        EXPECT_LT((*found * p - (expected * p.homogeneous()).head<3>()).norm(), 1e-8) << "trial " << trial;
    }
  }
}

TEST(Umeyama, FindsAPlantedSimilarityAndNeverAReflection) {
  Random random(4);
  const Similarity planted{1.7, {Vec3(5, -3, 2), random_turn(random)}};
  std::vector<Vec3> flat, moved, mirrored;
  for (int i = 0; i < 30; ++i) {
    flat.push_back(
        {random.uniform(-5, 5), random.uniform(-5, 5), 0});  // in a plane a mirror image fits as well
    moved.push_back(planted * flat.back());
  }
  const auto found = umeyama(flat, moved, true);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->scale, 1.7, 1e-12);
  EXPECT_LT((found->T_to_from.position - planted.T_to_from.position).norm(), 1e-10);
  EXPECT_LT(found->T_to_from.orientation.angularDistance(planted.T_to_from.orientation), 1e-7);
}

TEST(Umeyama, SaysNothingWhereTheRotationIsNotDetermined) {
  EXPECT_FALSE(umeyama({Vec3(0, 0, 0), Vec3(1, 0, 0)}, {Vec3(0, 0, 0), Vec3(1, 0, 0)}, false));
  const std::vector<Vec3> line = {Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(2, 2, 0), Vec3(5, 5, 0)};
  EXPECT_FALSE(umeyama(line, line, false));
  const std::vector<Vec3> point(5, Vec3(1, 2, 3));
  EXPECT_FALSE(umeyama(point, point, true));
}

}  // namespace
}  // namespace karst::evaluation
