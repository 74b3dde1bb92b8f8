#include "plugins/simulator/sensors/pose_sensor.h"

#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using core::Pose;
using sim::PoseSensor;
using sim::PoseSensorOptions;

PoseSensorOptions ideal() {
  PoseSensorOptions o;
  o.noise_m = o.noise_rad = o.drift_percent = o.heading_drift_rad = 0;
  return o;
}

TEST(PoseSensor, WithoutErrorsItReadsTheTruth) {
  PoseSensor sensor(ideal(), {}, core::Random(1));
  const Pose p{{1, 2, 3}, core::from_heading(0.7)};
  const auto s = sensor.sample(5, p);
  EXPECT_EQ(s.stamp, 5);
  EXPECT_EQ(s.T_world_body.position, p.position);
  EXPECT_LT(s.T_world_body.orientation.angularDistance(p.orientation), 1e-12);
}

TEST(PoseSensor, NoiseHasItsDeviation) {
  PoseSensorOptions o = ideal();
  o.noise_m = 0.01;
  o.noise_rad = 0.004;
  PoseSensor sensor(o, {}, core::Random(2));
  double square_m = 0, square_rad = 0;
  constexpr int kSamples = 5000;
  for (int i = 0; i < kSamples; ++i) {
    const auto s = sensor.sample(0, {});
    square_m += s.T_world_body.position.squaredNorm() / (3.0 * kSamples);
    const double angle = s.T_world_body.orientation.angularDistance(core::Quat::Identity());
    square_rad += angle * angle / (3.0 * kSamples);
  }
  EXPECT_NEAR(std::sqrt(square_m), 0.01, 0.0005);
  EXPECT_NEAR(std::sqrt(square_rad), 0.004, 0.0002);
}

TEST(PoseSensor, DriftAfter100mIsWhatTheOptionSaysWhateverTheRate) {
  PoseSensorOptions o = ideal();
  o.drift_percent = 0.02;
  for (const int steps : {100, 1000}) {
    double square = 0;
    constexpr int kFlights = 400;
    for (int k = 0; k < kFlights; ++k) {
      PoseSensor sensor(o, {}, core::Random(static_cast<std::uint64_t>(k)));
      Pose p;
      for (int i = 1; i <= steps; ++i) {
        p.position.x() = 100.0 * i / steps;
        const Vec3 error = sensor.sample(0, p).T_world_body.position - p.position;
        if (i == steps) square += error.squaredNorm() / kFlights;
      }
    }
    EXPECT_NEAR(std::sqrt(square), 0.02, 0.002);
  }
}

TEST(PoseSensor, StandingDoesNotDrift) {
  PoseSensorOptions o = ideal();
  o.drift_percent = 5;
  PoseSensor sensor(o, {}, core::Random(2));
  for (int i = 0; i < 100; ++i) EXPECT_EQ(sensor.sample(0, {}).T_world_body.position, Vec3::Zero());
}

}  // namespace
}  // namespace karst::test
