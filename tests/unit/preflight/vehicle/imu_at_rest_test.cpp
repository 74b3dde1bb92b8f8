#include "sdk/preflight/vehicle/imu_at_rest.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core_stack/common/random_vector.h"

namespace karst::preflight {
namespace {

using core::ImuSample;
using core::Vec3;

std::vector<ImuSample> still(const Vec3& force, const Vec3& rate, double force_noise = 0.05,
                             double rate_noise = 0.003) {
  std::vector<ImuSample> all;
  core::Random random(4);
  for (int i = 0; i < 3000; ++i)
    all.push_back({i * 5 * core::kMillisecond, force + force_noise * normal_vector(random),
                   rate + rate_noise * normal_vector(random)});
  return all;
}

TEST(ImuAtRest, MeasuresGravityBiasAndNoise) {
  const ImuAtRest imu = imu_at_rest(still({1, 0, 9.7}, {0.01, -0.02, 0}));
  EXPECT_EQ(imu.samples, 3000);
  EXPECT_NEAR(imu.gravity_mps2(), std::hypot(1, 9.7), 0.01);
  EXPECT_NEAR(imu.tilt_rad(), std::atan2(1, 9.7), 0.001);
  EXPECT_NEAR(imu.mean_rate_radps.x(), 0.01, 0.0005);
  EXPECT_NEAR(imu.force_noise_mps2, 0.05, 0.004);
  EXPECT_NEAR(imu.rate_noise_radps, 0.003, 0.0003);
  EXPECT_LT(imu.force_drift_mps2, 0.02);
  EXPECT_EQ(imu.repeated, 0);
}

TEST(ImuAtRest, UpsideDownIsATiltOfAHalfTurn) {
  EXPECT_NEAR(imu_at_rest(still({0, 0, -9.81}, Vec3::Zero(), 0, 0)).tilt_rad(), std::acos(-1.0), 1e-6);
}

TEST(ImuAtRest, CountsWhatIsNoNumber) {
  std::vector<ImuSample> samples = still({0, 0, 9.81}, Vec3::Zero());
  samples[7].body_rate_radps.y() = NAN;
  samples[9].specific_force_mps2.x() = INFINITY;
  const ImuAtRest imu = imu_at_rest(samples);
  EXPECT_EQ(imu.invalid, 2);
  EXPECT_EQ(imu.samples, 2998);
  EXPECT_TRUE(std::isfinite(imu.gravity_mps2()));
}

TEST(ImuAtRest, CountsRepeatedSamples) {
  std::vector<ImuSample> samples = still({0, 0, 9.81}, Vec3::Zero());
  for (std::size_t i = 1; i < samples.size(); i += 2) {
    samples[i].specific_force_mps2 = samples[i - 1].specific_force_mps2;
    samples[i].body_rate_radps = samples[i - 1].body_rate_radps;
  }
  EXPECT_NEAR(imu_at_rest(samples).repeated, 0.5, 0.001);
}

TEST(ImuAtRest, ATiltWhileItIsListenedToIsADrift) {
  std::vector<ImuSample> samples = still({0, 0, 9.81}, Vec3::Zero());
  for (std::size_t i = 1500; i < samples.size(); ++i) samples[i].specific_force_mps2.x() += 1;
  EXPECT_NEAR(imu_at_rest(samples).force_drift_mps2, 1, 0.01);
}

TEST(ImuAtRest, OfNothing) {
  EXPECT_EQ(imu_at_rest({}).samples, 0);
  EXPECT_EQ(imu_at_rest({}).tilt_rad(), 0);
  EXPECT_EQ(clipped_fraction({}), 0);
}

TEST(ClippedFraction, SeesAnAxisThatStaysAtItsLimit) {
  std::vector<ImuSample> samples;
  int beyond = 0;
  for (int i = 0; i < 1000; ++i) {
    const double rate = 5 * std::sin(0.05 * i);
    if (std::abs(rate) > 4.36) ++beyond;
    samples.push_back(
        {i, Vec3(0.01 * std::cos(i), 0.02 * std::sin(i), 9.8 + 0.01 * std::sin(1.3 * i)),
         Vec3(std::clamp(rate, -4.36, 4.36), 0.1 * std::sin(0.07 * i), 0.1 * std::cos(0.03 * i))});
  }
  EXPECT_NEAR(clipped_fraction(samples), beyond / 1000.0, 1e-9);
  EXPECT_EQ(clipped_fraction(still({0, 0, 9.81}, Vec3::Zero())), 0);
}

}  // namespace
}  // namespace karst::preflight
