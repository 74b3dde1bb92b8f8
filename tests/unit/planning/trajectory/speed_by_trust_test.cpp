#include "core_stack/planning/trajectory/speed_by_trust.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "core_stack/common/random.h"
#include "core_stack/planning/trajectory/trajectory.h"

namespace karst::core {
namespace {

TEST(SpeedByTrust, ReactionAndBrakingTakeTheFreeDistanceExactly) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random random(seed);
    const double free_m = random.uniform(0.1, 60), reaction_s = random.uniform(0, 2),
                 braking_mps2 = random.uniform(0.3, 8);
    const double v = stopping_speed_mps(free_m, reaction_s, braking_mps2);
    RC_ASSERT(std::abs(v * reaction_s + v * v / (2 * braking_mps2) - free_m) < 1e-9 * free_m);
  }));
}

TEST(SpeedByTrust, WithNothingFreeItStandsAndWithMoreItIsFaster) {
  EXPECT_EQ(stopping_speed_mps(0, 0.5, 2), 0);
  EXPECT_EQ(stopping_speed_mps(-3, 0.5, 2), 0);
  EXPECT_DOUBLE_EQ(stopping_speed_mps(9, 0, 2), 6);
  EXPECT_GT(stopping_speed_mps(10, 0.5, 2), stopping_speed_mps(9, 0.5, 2));
  EXPECT_LT(stopping_speed_mps(10, 0.7, 2), stopping_speed_mps(10, 0.5, 2));
}

TEST(SpeedByTrust, TheGapOfTheDefaultClearanceIsThatOfTwoMetresPerSecond) {
  EXPECT_DOUBLE_EQ(speed_beside_rock_mps(0.2), 2);
  EXPECT_EQ(speed_beside_rock_mps(-0.1), 0);
}

TEST(SpeedByTrust, LimitsCountFromTheEndAndTheLowerNeighbourHolds) {
  TrustedSpeeds t;
  EXPECT_TRUE(std::isinf(t.sight_at_mps(3)));
  t.sight_mps = {5, 3, 4};
  EXPECT_EQ(t.sight_at_mps(-1), 5);
  EXPECT_EQ(t.sight_at_mps(0), 5);
  EXPECT_EQ(t.sight_at_mps(0.1), 3);
  EXPECT_EQ(t.sight_at_mps(0.5), 3);
  EXPECT_EQ(t.sight_at_mps(0.9), 3);
  EXPECT_EQ(t.sight_at_mps(1), 4);
  EXPECT_EQ(t.sight_at_mps(70), 4) << "beyond the last one";
}

TEST(SpeedByTrust, ATrajectoryKeepsToItAndSaysWhy) {
  MotionLimits limits;
  limits.max_speed_mps = 8;
  SlowPlaces slow;
  slow.trusted.sight_mps.assign(121, 8);
  slow.trusted.room_mps.assign(121, 8);
  for (std::size_t i = 40; i <= 60; ++i) slow.trusted.sight_mps[i] = 3;  // 20 to 30 m before the end
  for (std::size_t i = 90; i <= 95; ++i) slow.trusted.room_mps[i] = 2.5;
  HeadingPlan heading;
  heading.along_path = false;
  const Trajectory t = sample_trajectory({{0, 0, 0}, {60, 0, 0}}, 0, 0, limits, heading, slow);
  double allowed_s = 0;
  for (std::size_t i = 1; i < t.samples.size(); ++i) {
    const double x = t.samples[i].position.x(), v = (x - t.samples[i - 1].position.x()) / seconds(t.period);
    const double to_end_m = 60 - x;
    if (to_end_m > 20.3 && to_end_m < 29.7) {
      EXPECT_LE(v, 3.001);
      EXPECT_TRUE(t.samples[i].limited_by == SpeedLimit::sight) << to_end_m;
    }
    if (to_end_m > 45.3 && to_end_m < 47.2) {
      EXPECT_LE(v, 2.501);
      EXPECT_TRUE(t.samples[i].limited_by == SpeedLimit::room) << to_end_m;
    }
    if (to_end_m > 30.7 && to_end_m < 32)
      EXPECT_TRUE(t.samples[i].limited_by == SpeedLimit::sight) << "it brakes for it";
    if (to_end_m < 5) EXPECT_TRUE(t.samples[i].limited_by == SpeedLimit::end);
    if (x < 3) EXPECT_TRUE(t.samples[i].limited_by == SpeedLimit::speeding_up);
    allowed_s += t.samples[i].limited_by == SpeedLimit::allowed;
  }
  EXPECT_EQ(allowed_s, 0) << "8 m/s is never reached";
}

}  // namespace
}  // namespace karst::core
