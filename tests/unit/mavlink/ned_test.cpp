#include "plugins/mavlink/ned.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "core_stack/common/random.h"
#include "plugins/mavlink/setpoints.h"

namespace karst::mavlink {
namespace {

using core::Quat;
using core::Vec3;

constexpr double kPi = std::numbers::pi;

TEST(Ned, NorthEastDown) {
  EXPECT_EQ(ned_of_enu({1, 2, 3}), Vec3(2, 1, -3));  // 1 east, 2 north, 3 up
  EXPECT_EQ(frd_of_flu({1, 2, 3}), Vec3(1, -2, -3));
}

TEST(Ned, AVehicleThatLooksNorthHasNoRotation) {
  const Quat north = core::from_heading(kPi / 2);
  EXPECT_NEAR(ned_frd_of_enu_flu(north).angularDistance(Quat::Identity()), 0, 1e-7);
  EXPECT_NEAR(yaw_of_heading(kPi / 2), 0, 1e-12);
  EXPECT_NEAR(yaw_of_heading(0), kPi / 2, 1e-12) << "east is a quarter turn clockwise from north";
}

TEST(Ned, RollToTheRightIsPositiveForBoth) {
  // In FLU a positive rotation about x lifts the left side: right side down, as in FRD.
  const Quat rolled = core::from_heading(kPi / 2) * Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX()));
  const Quat q = ned_frd_of_enu_flu(rolled);
  EXPECT_NEAR(q.x(), std::sin(0.15), 1e-9);
  EXPECT_NEAR(q.y(), 0, 1e-9);
  // Nose down: positive about y (left) in FLU, negative pitch in FRD.
  const Quat pitched = core::from_heading(kPi / 2) * Quat(Eigen::AngleAxisd(0.3, Vec3::UnitY()));
  EXPECT_NEAR(ned_frd_of_enu_flu(pitched).y(), -std::sin(0.15), 1e-9);
}

RC_GTEST_PROP(Ned, AVectorOfTheBodyIsTheSamePlaceInBothWorlds, (std::uint32_t seed)) {
  core::Random r(seed);
  const Quat q = Quat(r.normal(), r.normal(), r.normal(), r.normal()).normalized();
  const Vec3 v(r.normal(), r.normal(), r.normal());
  const Vec3 by_enu = ned_of_enu(q * v), by_ned = ned_frd_of_enu_flu(q) * frd_of_flu(v);
  RC_ASSERT((by_enu - by_ned).norm() < 1e-9);
  RC_ASSERT(enu_flu_of_ned_frd(ned_frd_of_enu_flu(q)).angularDistance(q) < 1e-6);
}

TEST(Setpoints, AReferenceInNedAndAheadOfTime) {
  core::Reference r;
  r.position = {1, 2, 3};
  r.velocity_mps = {0.5, 0, -0.25};
  r.acceleration_mps2 = {0, 2, 0};
  r.heading_rad = kPi / 2;
  r.heading_rate_radps = 0.5;
  const auto m = position_target(r, 0.1, core::kSecond);
  EXPECT_EQ(m.time_boot_ms, 1000u);
  EXPECT_EQ(m.coordinate_frame, kLocalNed);
  EXPECT_EQ(m.type_mask, 0) << "nothing is ignored";
  EXPECT_NEAR(m.x, 2.01, 1e-6);
  EXPECT_NEAR(m.y, 1.05, 1e-6);
  EXPECT_NEAR(m.z, -2.975, 1e-6);
  EXPECT_NEAR(m.vx, 0.2, 1e-6);
  EXPECT_NEAR(m.vy, 0.5, 1e-6);
  EXPECT_NEAR(m.vz, 0.25, 1e-6);
  EXPECT_NEAR(m.afx, 2, 1e-6);
  EXPECT_NEAR(m.yaw, -0.05, 1e-6);
  EXPECT_NEAR(m.yaw_rate, -0.5, 1e-6);
}

TEST(Setpoints, RatesInFrdAndThrustByTheHoverThrust) {
  const auto m = rates_target({{0.1, 0.2, 0.3}, 30, true}, 0.5 / 20, 0);
  EXPECT_EQ(m.type_mask, kIgnoreAttitude);
  EXPECT_NEAR(m.body_roll_rate, 0.1, 1e-6);
  EXPECT_NEAR(m.body_pitch_rate, -0.2, 1e-6);
  EXPECT_NEAR(m.body_yaw_rate, -0.3, 1e-6);
  EXPECT_NEAR(m.thrust, 0.75, 1e-6);
  EXPECT_EQ(rates_target({{}, 30, false}, 0.5 / 20, 0).thrust, 0);
  EXPECT_EQ(rates_target({{}, 300, true}, 0.5 / 20, 0).thrust, 1);
}

TEST(Setpoints, VisionHasTheVelocityInTheBodyAndItsOwnStamp) {
  core::State s;
  s.stamp = 1234 * core::kMillisecond;
  s.position = {1, 2, 3};
  s.orientation = core::from_heading(kPi / 2);  // north
  s.velocity_mps = {0, 1.5, 0};                 // north: ahead
  s.body_rate_radps = {0, 0, 0.4};
  const auto m = vision(s);
  EXPECT_EQ(m.time_usec, 1234000u);
  EXPECT_EQ(m.frame_id, kLocalFrd);
  EXPECT_EQ(m.child_frame_id, kBodyFrd);
  EXPECT_LE(m.estimator_type, kVio) << "PX4's EKF does not read the others";
  EXPECT_EQ(vision(s, 3).reset_counter, 3);
  EXPECT_NEAR(m.x, 2, 1e-6);
  EXPECT_NEAR(m.z, -3, 1e-6);
  EXPECT_NEAR(m.q[0], 1, 1e-6);
  EXPECT_NEAR(m.vx, 1.5, 1e-6);
  EXPECT_NEAR(m.vy, 0, 1e-6);
  EXPECT_NEAR(m.yawspeed, -0.4, 1e-6);
}

}  // namespace
}  // namespace karst::mavlink
