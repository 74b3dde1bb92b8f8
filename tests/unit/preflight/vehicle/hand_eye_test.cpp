#include "sdk/preflight/vehicle/hand_eye.h"

#include <gtest/gtest.h>

#include <numbers>

#include "sdk/preflight/vehicle/axis_map.h"
#include "tests/unit/preflight/vehicle/degree.h"
#include "tests/unit/preflight/vehicle/synthetic_motion.h"

namespace karst::preflight {
namespace {

using core::Vec3;

using test::kDegree;

TEST(GyroTrack, FollowsAMotionInClosedForm) {
  const std::vector<Orientation> track = gyro_track(test::imu_of_motion(20), Vec3::Zero());
  for (const double t : {1.0, 7.5, 20.0}) {
    const core::Quat expected = test::turned(0).conjugate() * test::turned(t);
    EXPECT_LT(expected.angularDistance(orientation_at(track, core::from_seconds(t))), 0.001) << t;
  }
}

TEST(GyroTrack, LeavesOutSamplesThatAreLateOrNoNumbers) {
  std::vector<core::ImuSample> samples = test::imu_of_motion(5);
  samples.insert(samples.begin() + 100, samples[50]);
  samples.insert(samples.begin() + 300, {samples[299].stamp + 1, Vec3::Zero(), Vec3::Constant(NAN)});
  EXPECT_EQ(gyro_track(samples, Vec3::Zero()).size(), samples.size() - 2);
}

TEST(GyroTrack, IsTheNearestEndOutside) {
  const std::vector<Orientation> track = gyro_track(test::imu_of_motion(1), Vec3::Zero());
  EXPECT_TRUE(orientation_at(track, -core::kSecond).isApprox(track.front().q));
  EXPECT_TRUE(orientation_at(track, 9 * core::kSecond).isApprox(track.back().q));
}

/// Mountings that are wrong about each axis, and about an oblique one.
class WrongMounting : public testing::TestWithParam<Vec3> {};

TEST_P(WrongMounting, IsFoundWithinItsUncertainty) {
  const Vec3 error = GetParam() * kDegree;
  const test::SyntheticImu imu{.bias_radps = {0.01, -0.02, 0.005}, .rate_noise_radps = 0.003};
  const auto track = gyro_track(test::imu_of_motion(25, imu), imu.bias_radps);
  const auto found = hand_eye(track, test::track_of_motion(25, error, 0.013, 0.003));
  ASSERT_TRUE(found.has_value());
  EXPECT_LT(found->sigma_rad, 0.3 * kDegree);
  EXPECT_LT((found->error_rad - error).norm(), 4 * found->sigma_rad);
  EXPECT_NEAR(found->delay_s, 0.013, 0.003);
  EXPECT_NEAR(found->scale, 1, 0.01);
  EXPECT_GT(found->explained, 0.98);
}

INSTANTIATE_TEST_SUITE_P(AboutEachAxis, WrongMounting,
                         testing::Values(Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(0, -3, 0), Vec3(0, 0, 3),
                                         Vec3(5, -4, 20)));

TEST(HandEye, FindsDelaysOfBothSigns) {
  const auto track = gyro_track(test::imu_of_motion(25), Vec3::Zero());
  for (const double delay_s : {-0.2, -0.05, 0.0, 0.03, 0.2, 0.4}) {
    const auto found = hand_eye(track, test::track_of_motion(25, Vec3::Zero(), delay_s, 0.002));
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->delay_s, delay_s, 0.003);
    EXPECT_LT(found->delay_sigma_s, 0.005);
  }
}

TEST(HandEye, SeesSwappedAxesOfTheGyroscopeAsTheMapBetweenThem) {
  std::vector<core::ImuSample> samples = test::imu_of_motion(25);
  for (core::ImuSample& s : samples) std::swap(s.body_rate_radps.x(), s.body_rate_radps.y());
  const auto found = hand_eye(gyro_track(samples, Vec3::Zero()), test::track_of_motion(25));
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(axis_words(nearest_axis_map(found->map)), "x is y, y is x, z is z");
}

TEST(HandEye, SeesTheScaleOfTheGyroscope) {
  std::vector<core::ImuSample> samples = test::imu_of_motion(25);
  for (core::ImuSample& s : samples) s.body_rate_radps *= 1.2;
  const auto found = hand_eye(gyro_track(samples, Vec3::Zero()), test::track_of_motion(25));
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(1 / found->scale, 1.2, 0.03);
}

TEST(HandEye, LeavesOutScansThatWereMatchedWrongly) {
  const auto track = gyro_track(test::imu_of_motion(25), Vec3::Zero());
  std::vector<Orientation> lidar = test::track_of_motion(25, Vec3::Zero(), 0, 0.002);
  for (const std::size_t i : {50u, 120u, 200u}) lidar[i].q = lidar[i].q * core::exp_so3(Vec3(0.3, -0.2, 0.4));
  const auto found = hand_eye(track, lidar);
  ASSERT_TRUE(found.has_value());
  EXPECT_LT(found->error_rad.norm(), 0.3 * kDegree);
}

TEST(HandEye, SaysWhenOneAxisWasHardlyTurned) {
  const test::SyntheticImu about_z{.amplitude_rad = {0, 0, 0.9}};
  const auto track = gyro_track(test::imu_of_motion(25, about_z), Vec3::Zero());
  std::vector<Orientation> lidar;
  for (int i = 0; i <= 250; ++i)
    lidar.push_back({core::from_seconds(i / 10.0), test::turned(i / 10.0, about_z.amplitude_rad)});
  const auto found = hand_eye(track, lidar);
  ASSERT_TRUE(found.has_value());
  EXPECT_LT(found->weakest_rate_radps, 0.01);
}

TEST(HandEye, NeedsScans) {
  const auto track = gyro_track(test::imu_of_motion(25), Vec3::Zero());
  EXPECT_FALSE(hand_eye(track, {}).has_value());
  EXPECT_FALSE(hand_eye(track, test::track_of_motion(2)).has_value());
  EXPECT_FALSE(hand_eye({}, test::track_of_motion(25)).has_value());
}

}  // namespace
}  // namespace karst::preflight
