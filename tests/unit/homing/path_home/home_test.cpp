#include "core_stack/homing/path_home/home.h"

#include <gtest/gtest.h>

#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

using testing::all_cells;
using testing::WindingCave;

TEST(Home, TheWayIsAsLongAsTheCaveAndNotMuchLonger) {
  const WindingCave cave = WindingCave::of_length(30, 2, 1.6);
  const VoxelMap map = cave.map();
  Roadmap roadmap{PlanningOptions{}};
  roadmap.update(map, all_cells(map));
  const Vec3 home = cave.line[4], here = cave.line[52];
  PathHome path_home;
  path_home.update(map, roadmap, home, {});
  const std::optional<double> length_m = path_home.length_m(map, roadmap, here);
  ASSERT_TRUE(length_m);
  EXPECT_GT(*length_m, (here - home).norm());
  EXPECT_LT(*length_m, 1.25 * 24.0);  // the centre line between them
  const Path path = path_home.find(map, roadmap, here);
  ASSERT_TRUE(path.found());
  EXPECT_EQ(path.points.front(), here);
  EXPECT_EQ(path.points.back(), home);
  EXPECT_NEAR(path.length_m, *length_m, 0.05 * *length_m);  // cell by cell where straight lines are not clear
}

TEST(Home, WithoutAWayThereIsNoLength) {
  const WindingCave cave = WindingCave::of_length(10, 2, 1.6);
  const VoxelMap map = cave.map();
  Roadmap roadmap{PlanningOptions{}};
  roadmap.update(map, all_cells(map));
  PathHome path_home;
  path_home.update(map, roadmap, {0, 0, 40}, {});
  EXPECT_FALSE(path_home.length_m(map, roadmap, cave.line[4]));
  EXPECT_FALSE(path_home.find(map, roadmap, cave.line[4]).reason.empty());
}

TEST(Home, TimeFromRestToRestAndTheDescent) {
  MotionLimits limits;
  limits.max_speed_mps = 2;
  limits.max_acceleration_mps2 = 2;
  // 0.8 of 2 m/s is held: 12 m take 7.5 s, the ramps 0.8 s more; 0.8 m of descent at 0.4 m/s take 2 s.
  EXPECT_NEAR(home_time_s(12.0, 0.2, 1.0, limits, 0.4), 10.3, 1e-9);
  // Half a metre is over before the cruise is reached: 2 sqrt(l / a).
  EXPECT_NEAR(home_time_s(0.5, 0, 0, limits, 0.4), 1.0, 1e-9);
  EXPECT_NEAR(home_time_s(0, 0, 0, limits, 0.4), 0.0, 1e-9);
  double before = 0;
  for (double length = 0.1; length < 3; length += 0.1) {
    EXPECT_GT(home_time_s(length, 0, 0, limits, 0.4), before);
    before = home_time_s(length, 0, 0, limits, 0.4);
  }
}

TEST(Home, SlackIsWhatTheBatteryLeavesAfterTheWayHomeAndTheReserve) {
  EXPECT_NEAR(home_slack_s(100, 40, 0.25, 30), 20, 1e-12);
  EXPECT_LT(home_slack_s(100, 60, 0.25, 30), 0);
}

TEST(Home, TurnsBackAtOnceWhereTheSlackIsUsedUpInFlight) {
  ReturnTrigger return_trigger;
  for (double slack_s = 20; slack_s > 0; slack_s -= 2.5) EXPECT_FALSE(return_trigger.due(slack_s));
  EXPECT_TRUE(return_trigger.due(-2.0));
}

TEST(Home, AWayHomeThatTheMapShutsForAMomentIsNotBelieved) {
  ReturnTrigger return_trigger;
  for (const double slack_s : {100.0, -120.0, -121.0, -122.0, 97.0, -120.0, -121.0, -122.0})
    EXPECT_FALSE(return_trigger.due(slack_s)) << slack_s;
  EXPECT_TRUE(return_trigger.due(-123.0)) << "shut for longer than a moment";
}

}  // namespace
}  // namespace karst::core
