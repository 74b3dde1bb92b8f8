#include "sdk/preflight/time_budget.h"

#include <gtest/gtest.h>

#include <optional>

namespace karst::preflight {
namespace {

/// 2 m/s at most, of which 80 % are flown, and 2 m/s^2: 16 m take 16 / 1.6 + 1.6 / 2 = 10.8 s from rest to
/// rest. 0.7 m of climb or descent at 0.4 m/s take 1.75 s.
TimeLimits limits_with(std::optional<double> battery_s) {
  TimeLimits l;
  l.battery_s = battery_s;
  l.motion.max_speed_mps = 2;
  l.motion.max_acceleration_mps2 = 2;
  return l;
}

TEST(TimeBudget, OfACaveThatTheBatteryOutlasts) {
  const TimeBudget b = time_budget(limits_with(480), 16);
  EXPECT_EQ(b.endurance_s, 480);
  EXPECT_TRUE(b.can_explore);
  EXPECT_TRUE(b.reaches_all());
  EXPECT_NEAR(b.home_s, 12.55, 1e-9);
  EXPECT_NEAR(b.turn_back_s, 480 - 20 - 1.15 * 12.55, 1e-9);
  EXPECT_NEAR(b.return_s, 480 - 20 - 0.15 * 12.55, 1e-9);
}

TEST(TimeBudget, TheLesserOfBatteryAndFlightTimeAllowedCounts) {
  TimeLimits l = limits_with(480);
  l.max_flight_time_s = 300;
  EXPECT_EQ(time_budget(l, 16).endurance_s, 300);
  l.max_flight_time_s = 3600;
  EXPECT_EQ(time_budget(l, 16).endurance_s, 480);
  l.battery_s.reset();
  EXPECT_EQ(time_budget(l, 16).endurance_s, 3600);
}

// (2 + margin) (d / 1.6 + 0.8 + 1.75) = 100 - 20
TEST(TimeBudget, InADeepCaveTheVehicleTurnsBackWhereItMust) {
  const TimeBudget b = time_budget(limits_with(100), 1000);
  const double out_s = 80 / 2.15;
  EXPECT_FALSE(b.reaches_all());
  EXPECT_NEAR(b.reach_m, 1.6 * (out_s - 2.55), 1e-6);
  EXPECT_NEAR(b.turn_back_s, out_s, 1e-6);
  EXPECT_NEAR(b.return_s, 2 * out_s, 1e-6);
}

// 20 s of reserve, 1.75 s of climb, and 1.15 times as much of descent: 23.76 s.
TEST(TimeBudget, WithoutTimeForMoreThanUpAndDownNothingIsExplored) {
  EXPECT_FALSE(time_budget(limits_with(23.7), 100).can_explore);
  EXPECT_EQ(time_budget(limits_with(23.7), 100).reach_m, 0);
  EXPECT_TRUE(time_budget(limits_with(23.8), 100).can_explore);
}

// 30 s allow 3 m from the start: a flight refused every goal and landed. With 36 s one flew 14 m.
// A stride is 4 s at 1.6 m/s.
TEST(TimeBudget, LessThanAStrideFromTheStartIsNoExploring) {
  TimeLimits l = limits_with(std::nullopt);
  l.max_flight_time_s = 30;
  EXPECT_TRUE(time_budget(l, 80).can_explore);
  EXPECT_NEAR(time_budget(l, 80).stride_m, 6.4, 1e-9);
  EXPECT_FALSE(time_budget(l, 80).explores());
  EXPECT_TRUE(time_budget(l, 2).explores()) << "all of a cave of 2 m is reached";
  l.max_flight_time_s = 36;
  EXPECT_TRUE(time_budget(l, 80).explores());
  l.home_reserve_s = 30;
  EXPECT_FALSE(time_budget(l, 80).explores());
}

TEST(TimeBudget, IsNeverNegative) {
  const TimeBudget b = time_budget(limits_with(6), 100);
  EXPECT_FALSE(b.can_explore);
  EXPECT_GE(b.turn_back_s, 0);
}

}  // namespace
}  // namespace karst::preflight
