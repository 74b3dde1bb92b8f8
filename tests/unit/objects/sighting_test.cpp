#include "core_stack/objects/sighting.h"

#include <gtest/gtest.h>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

TEST(Sighting, LiesWhereTheCameraPointsInAnyPose) {
  const Pose T{{3, -2, 1}, Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()))};
  const Vec3 object(5, 1, 2), in_camera = T.inverse() * object;
  ObjectDetection d;
  d.kind = ObjectKind::rope;
  d.direction = in_camera.normalized(), d.range_m = in_camera.norm();
  const Sighting s = locate(d, T);
  EXPECT_EQ(s.kind, ObjectKind::rope);
  EXPECT_LT((s.position - object).norm(), 1e-12);
}

TEST(Sighting, HasTheCovarianceOfManyNoisyLooks) {
  const Pose T{{1, 2, 3}, Quat(Eigen::AngleAxisd(-1.1, Vec3(2, -1, 1).normalized()))};
  ObjectDetection d;
  d.direction = Vec3(1, 0.3, -0.2).normalized(), d.range_m = 4;
  d.bearing_sigma_rad = 0.02, d.range_sigma_m = 0.3;
  const Mat3 told = locate(d, T).covariance;
  // Two directions across the sight, by another way than the code has it.
  const Vec3 a = Vec3(-0.3, 1, 0).normalized(), b = d.direction.cross(a).normalized();
  Random random(3);
  Mat3 sum = Mat3::Zero();
  constexpr int kLooks = 200000;
  const Vec3 mean = T * (d.range_m * d.direction);
  for (int i = 0; i < kLooks; ++i) {
    ObjectDetection n = d;
    n.direction = (d.direction + 0.02 * random.normal() * a + 0.02 * random.normal() * b).normalized();
    n.range_m += 0.3 * random.normal();
    const Vec3 off = locate(n, T).position - mean;
    sum += off * off.transpose();
  }
  // The mean of so many squares is good to 0.3 %; the bend of the bearings' shell adds less than that.
  EXPECT_LT((sum / kLooks - told).norm(), 0.01 * told.norm()) << sum / kLooks << "\n\n" << told;
}

TEST(Mahalanobis, IsTheEuclideanDistanceInUnitsOfTheDeviation) {
  const Mat3 S = Vec3(4, 9, 0.25).asDiagonal();
  EXPECT_NEAR(mahalanobis2({2, 3, 0.5}, S), 3, 1e-12);
}

TEST(ObjectKind, NamesAndNumbersAreEachOthersInverse) {
  for (int i = 1; i <= kObjectKinds; ++i) {
    const auto kind = static_cast<ObjectKind>(i);
    EXPECT_EQ(parse<ObjectKind>(name_of(kind)), kind);
  }
  EXPECT_FALSE(parse<ObjectKind>("dragon"));
  EXPECT_STREQ(name_of(static_cast<ObjectKind>(200)), "unknown");
}

}  // namespace
}  // namespace karst::core
