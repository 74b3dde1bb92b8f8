#include "core_stack/mission/phases/goal_tracker.h"

#include "tests/unit/mission/onboard_fixture.h"

namespace karst::core {
namespace {

Goal goal_at(double x, std::uint32_t frontier = 0) {
  Goal g;
  g.position = {x, 0, 1};
  g.frontier_id = frontier;
  return g;
}

class GoalTrackerTest : public OnboardTest {};

TEST_F(GoalTrackerTest, ANewGoalSupersedesTheOneUnderWayUnlessItIsTheSame) {
  goals.accept(goal_at(1), 1);
  goals.accept(goal_at(1.2), 2);
  EXPECT_EQ(told("superseded"), 0u) << "20 cm apart are the same goal";
  goals.accept(goal_at(3), 3);
  EXPECT_EQ(told("superseded"), 1u);
  EXPECT_EQ(told("accepted"), 3u);
  CycleInput input;
  goals.tell(input);
  EXPECT_EQ(input.last_fate, GoalFate::under_way);
  EXPECT_EQ(input.last_goal->position.x(), 3);
  ASSERT_EQ(input.events.size(), 1u);
  EXPECT_EQ(input.events[0].kind, PolicyEvent::Kind::goal_superseded);
  EXPECT_EQ(input.events[0].reason, "the policy chose another");
}

TEST_F(GoalTrackerTest, AnAppendedGoalTakesThePlaceOfTheOneThatIsPassed) {
  goals.accept(goal_at(1), 1);
  goals.append(goal_at(5), 2);
  EXPECT_EQ(goals.goal()->position.x(), 1);
  goals.pass(3);
  EXPECT_EQ(goals.goal()->position.x(), 5);
  EXPECT_FALSE(goals.next());
  EXPECT_EQ(told("\"reached\""), 1u);
}

TEST_F(GoalTrackerTest, AFrontierThatIsReachedOrSeenOnTheWayIsLookedAtAndNoOther) {
  goals.accept(goal_at(1, 4), 1);
  goals.close_goal(GoalFate::reached, "", 2);
  goals.accept(goal_at(2, 5), 3);
  goals.note_frontier(5, false);
  EXPECT_FALSE(goals.frontier_open());
  goals.accept(goal_at(9, 6), 4);
  EXPECT_EQ(told("its frontier has been seen"), 1u);
  goals.close_goal(GoalFate::unreachable, "no path", 5);
  CycleInput input;
  goals.tell(input);
  EXPECT_EQ(input.looked_at, (std::vector<std::uint32_t>{4, 5}));
  EXPECT_EQ(input.last_fate, GoalFate::unreachable);
  goals.tell(input);
  EXPECT_TRUE(input.looked_at.empty()) << "told once";
  EXPECT_TRUE(input.events.empty());
}

TEST_F(GoalTrackerTest, WhatTheMapSaysOfAnotherFrontierDoesNotCount) {
  goals.accept(goal_at(2, 5), 1);
  goals.note_frontier(4, false);  // asked before the goal was accepted
  EXPECT_TRUE(goals.frontier_open());
  goals.close_goal(GoalFate::reached, "", 2);
  goals.note_frontier(0, false);
  EXPECT_TRUE(goals.frontier_open());
}

TEST_F(GoalTrackerTest, NothingIsSettledOrDroppedWhereThereIsNothing) {
  goals.close_goal(GoalFate::reached, "", 1);
  goals.drop_next(GoalFate::superseded, "", 1);
  EXPECT_TRUE(goals.take_events().empty());
  EXPECT_EQ(events(), "");
  goals.refuse(goal_at(7));
  CycleInput input;
  goals.tell(input);
  EXPECT_EQ(input.last_fate, GoalFate::rejected);
  EXPECT_EQ(input.last_goal->position.x(), 7);
}

}  // namespace
}  // namespace karst::core
