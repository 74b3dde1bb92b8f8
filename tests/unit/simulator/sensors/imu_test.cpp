#include "plugins/simulator/sensors/imu.h"

#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using sim::Imu;
using sim::ImuOptions;

TEST(Imu, WithoutNoiseItReadsTheTruth) {
  const ImuOptions ideal{0, 0, 0, 0, 0, 0};
  Imu imu(ideal, core::Random(1));
  const auto s = imu.sample(7, {0, 0, 9.81}, {0.1, 0.2, 0.3}, 0.005);
  EXPECT_EQ(s.stamp, 7);
  EXPECT_EQ(s.specific_force_mps2, Vec3(0, 0, 9.81));
  EXPECT_EQ(s.body_rate_radps, Vec3(0.1, 0.2, 0.3));
}

TEST(Imu, NoiseHasItsDeviationAroundTheBias) {
  ImuOptions o;
  o.accelerometer_walk = o.gyroscope_walk = 0;
  Imu imu(o, core::Random(2));
  constexpr int kSamples = 20000;
  Vec3 mean = Vec3::Zero(), rate = Vec3::Zero();
  double square = 0;
  for (int i = 0; i < kSamples; ++i) {
    const auto s = imu.sample(0, {0, 0, 9.81}, Vec3::Zero(), 0.005);
    mean += s.specific_force_mps2 / kSamples;
    rate += s.body_rate_radps / kSamples;
    square += (s.body_rate_radps - imu.gyroscope_bias_radps()).squaredNorm() / (3.0 * kSamples);
  }
  EXPECT_LT((mean - Vec3(0, 0, 9.81)).norm(), 5 * o.accelerometer_bias_mps2);
  EXPECT_GT((mean - Vec3(0, 0, 9.81)).norm(), 1e-4) << "there is a bias";
  EXPECT_LT((rate - imu.gyroscope_bias_radps()).norm(), 1e-4);
  EXPECT_NEAR(std::sqrt(square), o.gyroscope_noise_radps, 0.03 * o.gyroscope_noise_radps);
}

TEST(Imu, BiasWalksWithTheSquareRootOfTime) {
  ImuOptions o;
  o.gyroscope_walk = 0.001;
  double square = 0;
  constexpr int kUnits = 400;
  for (int k = 0; k < kUnits; ++k) {
    Imu imu(o, core::Random(static_cast<std::uint64_t>(k)));
    const Vec3 before = imu.gyroscope_bias_radps();
    for (int i = 0; i < 400; ++i) imu.sample(0, Vec3::Zero(), Vec3::Zero(), 0.01);  // 4 s
    square += (imu.gyroscope_bias_radps() - before).squaredNorm() / (3.0 * kUnits);
  }
  EXPECT_NEAR(std::sqrt(square), 0.001 * 2, 0.0002);
}

TEST(Imu, VibrationHasItsDeviationInFlightAndTouchesNoOtherNoise) {
  ImuOptions o;
  o.vibration_mps2 = 3;
  o.gyroscope_vibration_radps = 0.02;
  Imu still(o, core::Random(3), core::Random(4)), flying(o, core::Random(3), core::Random(4));
  constexpr int kSamples = 20000;
  Vec3 force = Vec3::Zero(), rate = Vec3::Zero(), force_mean = Vec3::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const core::TimeNs t = i * 5 * core::kMillisecond;
    const auto a = still.sample(t, {0, 0, 9.81}, Vec3::Zero(), 0.005),
               b = flying.sample(t, {0, 0, 9.81}, Vec3::Zero(), 0.005, true);
    const Vec3 f = b.specific_force_mps2 - a.specific_force_mps2, w = b.body_rate_radps - a.body_rate_radps;
    force += f.cwiseAbs2() / kSamples, rate += w.cwiseAbs2() / kSamples, force_mean += f / kSamples;
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(std::sqrt(force[k]), 3, 0.1);
    EXPECT_NEAR(std::sqrt(rate[k]), 0.02, 0.001);
  }
  EXPECT_LT(force_mean.norm(), 0.02) << "it shakes, it does not push";
}

}  // namespace
}  // namespace karst::test
