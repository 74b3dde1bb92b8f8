#include "sdk/preflight/vehicle/axis_map.h"

#include <gtest/gtest.h>

#include "tests/unit/preflight/vehicle/synthetic_motion.h"

namespace karst::preflight {
namespace {

using core::Vec3;
using Eigen::Matrix3d;

TEST(AxisMap, ThereAre48DifferentOnes) {
  const std::vector<Matrix3d>& maps = axis_maps();
  EXPECT_EQ(maps.size(), 48u);
  EXPECT_TRUE(is_identity(maps.front()));
  for (std::size_t i = 0; i < maps.size(); ++i) {
    EXPECT_TRUE((maps[i] * maps[i].transpose()).isApprox(Matrix3d::Identity()));
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(maps[i].isApprox(maps[j]));
  }
}

TEST(AxisMap, TheNearestOneOfASmallRotationOfEachIsItself) {
  const Matrix3d small = core::exp_so3(Vec3(0.2, -0.3, 0.2)).toRotationMatrix();
  for (const Matrix3d& map : axis_maps()) EXPECT_TRUE(nearest_axis_map(small * map).isApprox(map));
}

TEST(AxisMap, IsNamedByWhatEachAxisIs) {
  EXPECT_EQ(axis_words(Matrix3d::Identity()), "x is x, y is y, z is z");
  Matrix3d m;
  m << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_EQ(axis_words(m), "x is -y, y is x, z is z");
}

/// A field that stands still, as a sensor measures it whose axes are turned by `mounting`.
std::vector<VectorSample> field_of_motion(const Matrix3d& mounting) {
  std::vector<VectorSample> samples;
  core::Random random(3);
  for (int i = 0; i < 500; ++i) {
    const double t = i / 20.0;
    samples.push_back({core::from_seconds(t), mounting * (test::turned(t).conjugate() * Vec3(3, 20, -44)) +
                                                  0.5 * normal_vector(random)});
  }
  return samples;
}

TEST(AxisTest, FindsHowACompassIsTurned) {
  const auto track = gyro_track(test::imu_of_motion(25), Vec3::Zero());
  for (const Matrix3d& mounting : axis_maps()) {
    const AxisTest test = axes_of_vectors(field_of_motion(mounting), track);
    const Matrix3d expected = mounting.determinant() * mounting.transpose();  // see axes_of_vectors
    EXPECT_TRUE(test.best.isApprox(expected)) << axis_words(mounting);
    EXPECT_EQ(test.turned(), !is_identity(expected)) << axis_words(mounting);
  }
}

TEST(AxisTest, FindsHowTheGyroscopeIsTurnedAgainstTheAccelerometer) {
  const test::SyntheticImu noisy{.rate_noise_radps = 0.003, .force_noise_mps2 = 1.0};
  for (std::size_t i = 0; i < axis_maps().size(); i += 5) {
    const Matrix3d& mounting = axis_maps()[i];
    std::vector<core::ImuSample> samples = test::imu_of_motion(10, noisy);
    for (core::ImuSample& s : samples) s.body_rate_radps = mounting * s.body_rate_radps;
    const AxisTest test = axes_of_gyroscope(samples, Vec3::Zero());
    EXPECT_TRUE(test.best.isApprox(mounting.transpose())) << axis_words(mounting);
    EXPECT_EQ(test.turned(), !is_identity(mounting)) << axis_words(mounting);
  }
}

TEST(AxisTest, AccusesNobodyAtRest) {
  std::vector<VectorSample> still(200, {0, Vec3(3, 20, -44)});
  EXPECT_FALSE(axes_of_vectors(still, std::vector<Orientation>{{0, core::Quat::Identity()}}).turned());
  EXPECT_FALSE(axes_of_vectors({}, {}).turned());
  EXPECT_FALSE(axes_of_gyroscope({}, Vec3::Zero()).turned());
}

}  // namespace
}  // namespace karst::preflight
