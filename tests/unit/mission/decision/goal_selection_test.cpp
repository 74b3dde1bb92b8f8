#include "core_stack/mission/decision/goal_selection.h"

#include <gtest/gtest.h>

#include <limits>

#include "core_stack/homing/path_home/home.h"
#include "tests/unit/mission/mapped_world.h"

namespace karst::core {
namespace {

/// A vehicle at (3, 3, 2) in a room.
struct Selecting {
  CoreOptions options;
  VehicleDescription vehicle = lidar_vehicle_at_start();
  WorldModel world;
  TeamMembership alone;
  HomeEstimator home;
  GoalLedger ledger;
  GoalSelection selection;
  CycleInput input;

  explicit Selecting(const VoxelMap& map = room_open_to_x())
      : world(options, vehicle),
        home(options, vehicle, world, alone),
        selection(options, vehicle, world, home, ledger) {
    world.integrate(rays_of(map));
    input.from = Vec3(3, 3, 2);
    input.seconds_left = 600;
  }
  GoalChoice choose(const std::vector<Goal>& goals) {
    return selection.choose({&world.usual(), &input, {.at = input.now}}, goals);
  }
};

Goal goal_at(const Vec3& p) {
  Goal goal;
  goal.position = p;
  return goal;
}

TEST(GoalSelection, TakesTheFirstGoalThatCanBeFlownToAndSaysWhyNotTheOnesBefore) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Selecting s;
  s.ledger.close(s.world.map(), Vec3(5, 5, 2), 0, "nothing there");
  Goal turned = goal_at(Vec3(5, 3, 2)), slow = turned;
  turned.heading_rad = std::numeric_limits<double>::infinity();
  slow.max_speed_mps = 0.01;
  const std::pair<Goal, std::string> bad[] = {{goal_at(Vec3(nan, 0, 0)), "its position is not finite"},
                                              {turned, "its heading is not finite"},
                                              {slow, "motion.min_speed"},
                                              {goal_at(Vec3(50, 50, 50)), "unknown space"},
                                              {goal_at(Vec3(0.1, 3, 2)), "occupied"},
                                              {goal_at(Vec3(0.5, 3, 2)), "too near"},
                                              {goal_at(Vec3(5, 5, 2)), "tried before: nothing there"}};
  std::vector<Goal> goals;
  for (const auto& [goal, reason] : bad) goals.push_back(goal);
  EXPECT_FALSE(s.choose(goals).goal);
  goals.push_back(goal_at(Vec3(5, 3, 2)));
  goals.push_back(goal_at(Vec3(4, 3, 2)));
  const GoalChoice choice = s.choose(goals);
  ASSERT_TRUE(choice.goal);
  EXPECT_EQ(choice.goal->position, Vec3(5, 3, 2));
  EXPECT_NEAR(choice.path.length_m, 2, 0.05);
  ASSERT_EQ(choice.rejected.size(), std::size(bad));
  for (std::size_t i = 0; i < std::size(bad); ++i)
    EXPECT_NE(choice.rejected[i].reason.find(bad[i].second), std::string::npos) << choice.rejected[i].reason;
  EXPECT_FALSE(choice.all_too_far);
}

TEST(GoalSelection, TriesFivePlansAndLeavesTheRestToTheNextCycle) {
  VoxelMap map = room_open_to_x();
  carve_box(map, Vec3(20, 0, 0), Vec3(30, 6, 4));  // no path leads there
  Selecting s(map);
  std::vector<Goal> goals;
  for (int i = 0; i < 7; ++i) goals.push_back(goal_at(Vec3(21.5 + i, 3, 2)));
  GoalChoice choice = s.choose(goals);
  EXPECT_EQ(choice.rejected.size(), 5u);
  for (const RejectedGoal& r : choice.rejected) EXPECT_EQ(r.reason.find("no path"), 0u) << r.reason;
  EXPECT_TRUE(choice.more_to_try);
  choice = s.choose(goals);
  ASSERT_EQ(choice.rejected.size(), 7u) << "those closed need no plan";
  for (std::size_t i = 0; i < 7; ++i)
    EXPECT_EQ(choice.rejected[i].reason.find(i < 5 ? "it was tried before: no path" : "no path"), 0u);
  EXPECT_FALSE(choice.more_to_try);
}

TEST(GoalSelection, AcceptsAGoalIfThereAndHomeLeavesTheReserve) {
  Selecting s;
  const Goal goal = goal_at(Vec3(6.5, 4, 2));
  const GoalChoice rich = s.choose({goal});
  ASSERT_TRUE(rich.goal);
  const double there_s = flight_time_s(rich.path.length_m, s.options.motion);
  const double back_m = s.world.usual().home_length_m(s.world.map(), goal.position).value_or(0);
  const double back_s = home_time_s(back_m, 1, s.world.home().z(), s.options.motion, 0.4);
  const double needed_s = there_s + 1.15 * back_s + 20;
  s.input.seconds_left = needed_s + 1e-6;
  EXPECT_TRUE(s.choose({goal}).goal);
  s.input.seconds_left = needed_s - 1e-6;
  const GoalChoice poor = s.choose({goal, goal_at(Vec3(6.5, 2, 2))});
  EXPECT_FALSE(poor.goal);
  EXPECT_TRUE(poor.all_too_far);
  EXPECT_FALSE(s.choose({goal, goal_at(Vec3(50, 50, 50))}).all_too_far) << "one was for another reason";
  s.input.seconds_left = 600;
  EXPECT_TRUE(s.choose({goal}).goal) << "too far does not close a place";
}

TEST(GoalSelection, ClosesGoalsThatWouldBeClimbedToBlindly) {
  VoxelMap chimney{MapOptions{}};
  carve_box(chimney, Vec3(0, 0, 0), Vec3(8, 6, 20), {"z+"});
  Selecting s(chimney);
  const Goal up = goal_at(Vec3(3, 3, 15));
  GoalChoice choice = s.choose({up});
  EXPECT_FALSE(choice.goal);
  ASSERT_EQ(choice.rejected.size(), 1u);
  const std::string why = choice.rejected[0].reason;
  EXPECT_EQ(why.find("no path"), std::string::npos);
  choice = s.choose({up});
  ASSERT_EQ(choice.rejected.size(), 1u);
  EXPECT_EQ(choice.rejected[0].reason, "it was tried before: " + why);
}

// As it was: a goal that was too steep from one place was closed from everywhere, until the map there
// changed. A vehicle with cameras left a chamber whose upper half it had not seen, and came back a minute
// later.
TEST(GoalSelection, TakesAGoalFromFartherAwayThatWasTooSteepFromNearBy) {
  VoxelMap hall{MapOptions{}};
  carve_box(hall, Vec3(0, 0, 0), Vec3(24, 6, 10));
  Selecting s(hall);
  const Goal up = goal_at(Vec3(4, 3, 7));
  EXPECT_FALSE(s.choose({up}).goal);
  s.input.from = Vec3(20, 3, 2);
  s.input.now = kSecond;
  EXPECT_FALSE(s.choose({up}).goal) << "a moment ago it was too steep";
  s.input.now = 3 * kSecond;
  EXPECT_TRUE(s.choose({up}).goal);
}

}  // namespace
}  // namespace karst::core
