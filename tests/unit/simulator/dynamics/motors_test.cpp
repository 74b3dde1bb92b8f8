#include "plugins/simulator/dynamics/motors.h"

#include <gtest/gtest.h>
// RapidCheck's header needs GoogleTest's before it.
#include <rapidcheck/gtest.h>

#include "core_stack/common/random.h"

namespace karst::test {
namespace {

using core::Vec3;
using sim::MotorModel;
using sim::MotorThrusts;
using sim::Wrench;

constexpr double kMax_n = 10.8;

TEST(Motors, EachMotorsTorqueFollowsFromItsPlace) {
  const MotorModel m;
  const double lever = m.arm_m / std::sqrt(2.0);
  const Vec3 places[] = {{lever, lever, 0}, {lever, -lever, 0}, {-lever, lever, 0}, {-lever, -lever, 0}};
  for (int i = 0; i < 4; ++i) {
    MotorThrusts f = MotorThrusts::Zero();
    f[i] = 3;
    const Wrench w = sim::wrench_of(m, f);
    const Vec3 expected = places[i].cross(Vec3(0, 0, 3));
    EXPECT_NEAR(w.torque_nm.x(), expected.x(), 1e-12);
    EXPECT_NEAR(w.torque_nm.y(), expected.y(), 1e-12);
    EXPECT_NEAR(std::abs(w.torque_nm.z()), 3 * m.yaw_moment_m, 1e-12);
    EXPECT_EQ(w.thrust_n, 3);
  }
}

TEST(Motors, AWornOneExertsItsShareFromItsTimeOn) {
  MotorModel m;
  const MotorThrusts f(1, 2, 3, 4);
  EXPECT_EQ(sim::exerted(m, f, 100), f);
  m.weak = 3;
  m.weak_after_s = 10;
  EXPECT_EQ(sim::exerted(m, f, 9.999), f);
  EXPECT_TRUE(sim::exerted(m, f, 10).isApprox(MotorThrusts(1, 2, 2.7, 4), 1e-12));
}

RC_GTEST_PROP(Motors, MixingInvertsTheWrenchWithinReach, (std::uint32_t seed)) {
  core::Random r(seed);
  const MotorModel m;
  MotorThrusts f;
  for (int i = 0; i < 4; ++i) f[i] = r.uniform(0.001, kMax_n - 0.001);  // off the limits, for rounding
  const Wrench w = sim::wrench_of(m, f);
  RC_ASSERT((sim::mix(m, kMax_n, w) - f).norm() < 1e-9);
}

RC_GTEST_PROP(Motors, MixingStaysWithinTheMotorsAndKeepsRollAndPitch, (std::uint32_t seed)) {
  core::Random r(seed);
  const MotorModel m;
  const Wrench wanted{r.uniform(-10, 80), {r.uniform(-1.4, 1.4), r.uniform(-1.4, 1.4), r.uniform(-2, 2)}};
  const MotorThrusts f = sim::mix(m, kMax_n, wanted);
  RC_ASSERT(f.minCoeff() >= 0);
  RC_ASSERT(f.maxCoeff() <= kMax_n);
  const Wrench got = sim::wrench_of(m, f);
  // Both torques together need a span of (|x| + |y|) / (2 lever) between two motors.
  const double lever = m.arm_m / std::sqrt(2.0);
  if ((std::abs(wanted.torque_nm.x()) + std::abs(wanted.torque_nm.y())) / (2 * lever) < kMax_n) {
    RC_ASSERT(std::abs(got.torque_nm.x() - wanted.torque_nm.x()) < 1e-9);
    RC_ASSERT(std::abs(got.torque_nm.y() - wanted.torque_nm.y()) < 1e-9);
  }
  RC_ASSERT(got.torque_nm.z() * wanted.torque_nm.z() >= -1e-12);
}

TEST(Motors, ThrustStepIsAFirstOrderLag) {
  const MotorModel m;
  MotorThrusts f = MotorThrusts::Zero();
  const MotorThrusts step = MotorThrusts::Constant(5);
  for (int i = 1; i <= 100; ++i) {
    f = sim::follow(m, f, step, 0.001);
    EXPECT_NEAR(f[0], 5 * (1 - std::exp(-i * 0.001 / m.time_constant_s)), 1e-9);
  }
}

TEST(Motors, TogetherTheyLiftWhatTheOptionSays) {
  const sim::BodyModel body;
  MotorModel m;
  m.thrust_to_weight = 2.2;
  EXPECT_NEAR(4 * sim::max_motor_thrust_n(m, body), 2.2 * 2 * 9.81, 1e-12);
}

}  // namespace
}  // namespace karst::test
