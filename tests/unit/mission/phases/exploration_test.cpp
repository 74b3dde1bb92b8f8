#include "core_stack/mission/phases/exploration.h"

#include "tests/unit/mission/drawn_map.h"
#include "tests/unit/mission/onboard_fixture.h"

namespace karst::core {
namespace {

class ExplorationTest : public OnboardTest {
 protected:
  using OnboardTest::OnboardTest;
  /// In a hall around the vehicle that is open at one end, or closed.
  void begin(const std::vector<std::string>& open = {"x+"}) {
    onboard.map.while_idle().integrate(
        box_rays(VoxelMap{MapOptions{}}, Vec3(-3, -3, -1), Vec3(20, 6, 4), open));
    hover();
    onboard.map.while_idle().set_home(onboard.flight.reference().position);
    phases.enter(Phase::takeoff, now());
    phases.enter(Phase::explore, now());
    exploration.begin();
    policy.script = [this](const DecisionRequest& request) {
      ++asked;
      return answer(request);
    };
  }
  void steps(double s) {
    for (double t = 0; t < s; t += 0.1) {
      exploration.step();
      advance(0.1);
    }
  }
  static Decision go_to(const Vec3& place) {
    Decision d;
    d.outcome = Outcome::goals;
    Goal goal;
    goal.position = place;
    goal.heading_rad = std::numeric_limits<double>::quiet_NaN();
    d.goals = {goal};
    return d;
  }

  static Decision explored() {
    Decision d;
    d.outcome = Outcome::explored;
    d.reason = "all seen";
    return d;
  }

  int asked = 0;
  std::function<Decision(const DecisionRequest&)> answer = [](const DecisionRequest&) { return Decision{}; };
  std::string went_home;
  std::vector<Vec3> claimed;
  Exploration exploration{onboard,
                          {phases, goals, path, flown_path, endurance},
                          {.go_home = [this](const std::string& reason) { went_home = reason; },
                           .claim = [this](const Goal& g) { claimed.push_back(g.position); },
                           .teammates = [] { return std::vector<TeammateState>{}; }}};
};

CoreOptions sampled() {
  CoreOptions o;
  o.localization.source = PoseSource::pose_sensor;
  o.motion.trajectory = TrajectoryKind::sampled;
  return o;
}

struct SampledExplorationTest : ExplorationTest {
  SampledExplorationTest() : ExplorationTest(with_lidar(), sampled()) {}
};

TEST_F(ExplorationTest, AnAcceptedGoalIsFlownToClaimedAndReached) {
  begin();
  const Vec3 place(6, 0, 1);
  answer = [&](const DecisionRequest&) { return asked == 1 ? go_to(place) : Decision{}; };
  steps(1.5);
  ASSERT_TRUE(goals.goal()) << events();
  EXPECT_EQ(claimed, std::vector<Vec3>{place});
  double nearest_m = 9;
  for (int i = 0; i < 80; ++i) {
    steps(0.1);
    nearest_m = std::min(nearest_m, (onboard.flight.reference().position - place).norm());
  }
  EXPECT_LT(nearest_m, 0.6);
  EXPECT_EQ(told("\"reached\""), 1u);
}

// As it was: the next path was appended to one that the map had closed while the policy was asked, and the
// vehicle braked for it.
TEST_F(SampledExplorationTest, NothingIsAppendedToAPathThatTheMapHasClosedMeanwhile) {
  begin();
  answer = [&](const DecisionRequest&) { return go_to({asked == 1 ? 5.0 : 9.0, 0, 1}); };
  bool appends = false;
  for (int i = 0; i < 60 && !appends; ++i) {
    exploration.step();
    appends = goals.goal() && onboard.flight.remaining_s(now()) < onboard.options.mission.append_before_s;
    if (!appends) advance(0.1);
  }
  ASSERT_TRUE(appends) << events();
  path.ask_for_detour();
  advance(0.7);
  EXPECT_EQ(told("\"appending\":true"), 1u) << events();
  EXPECT_FALSE(goals.next());
  EXPECT_EQ(told("\"plan\""), 1u);
  steps(1);
  EXPECT_EQ(goals.goal()->position, Vec3(9, 0, 1)) << "the detour is taken from where it could stop";
}

TEST_F(ExplorationTest, ThePolicysWishToGoHomeIsFollowedAtTheEndOfTheRound) {
  begin();
  answer = [](const DecisionRequest&) {
    Decision d;
    d.outcome = Outcome::go_home;
    d.reason = "tea";
    return d;
  };
  exploration.step();
  EXPECT_EQ(went_home, "");
  steps(1.5);
  EXPECT_EQ(went_home, "the policy asked for it: tea");
}

// As it was: the first such answer ended the mission.
TEST_F(ExplorationTest, OneExploredBetweenGoalsDoesNotEndIt) {
  begin();
  answer = [&](const DecisionRequest&) { return asked == 1 ? explored() : go_to({6, 0, 1}); };
  steps(2);
  EXPECT_TRUE(goals.goal()) << events();
  EXPECT_EQ(went_home, "");
}

TEST_F(ExplorationTest, GoesHomeWhenAllAnswersOfFiveSecondsSayExplored) {
  begin();
  std::vector<TimeNs> at;
  answer = [&](const DecisionRequest& r) {
    at.push_back(r.stamp);
    return explored();
  };
  for (int i = 0; i < 100 && went_home.empty(); ++i) steps(0.1);
  EXPECT_EQ(went_home, "explored: all seen");
  ASSERT_GT(at.size(), 10u) << "it is asked again every 0.4 s";
  EXPECT_GE(at.back() - at.front(), 5 * kSecond);
  EXPECT_LT(at.back() - at.front(), 6 * kSecond);
  EXPECT_EQ(told("\"fallback\""), 0u) << "there are frontiers, but the policy has said that it wants none";
}

TEST_F(ExplorationTest, APolicyThatHasWaitedItselfIsBelievedSooner) {
  begin();
  std::vector<TimeNs> at;
  answer = [&](const DecisionRequest& r) {
    at.push_back(r.stamp);
    return r.stamp - at.front() < 1500 * kMillisecond ? Decision{} : explored();  // before the fallback flies
  };
  for (int i = 0; i < 200 && went_home.empty(); ++i) steps(0.1);
  EXPECT_EQ(went_home, "explored: all seen");
  EXPECT_GE(at.back() - at.front(), 5 * kSecond) << "without a goal";
  EXPECT_LT(at.back() - at.front(), 6 * kSecond);
}

TEST_F(ExplorationTest, NowExploredAndNowAGoalGoesOnExploring) {
  begin();
  int at_rest = 0;
  answer = [&](const DecisionRequest& r) {
    if (r.state.velocity_mps.norm() > 0.1) return Decision{};
    return ++at_rest % 2 == 1 ? explored() : go_to({r.state.position.x() < 3 ? 6.0 : 0.0, 0, 1});
  };
  steps(40);
  EXPECT_EQ(went_home, "");
  EXPECT_GT(told("\"reached\""), 2u);
}

TEST_F(ExplorationTest, APolicyThatNowHoldsAndNowSaysExploredStillComesHomeWhereNothingIsLeft) {
  begin({});
  answer = [&](const DecisionRequest&) { return asked % 2 == 1 ? explored() : Decision{}; };
  steps(2 + onboard.options.mission.explored_patience_s + 3);
  EXPECT_TRUE(went_home.starts_with("explored: ")) << went_home;
}

TEST_F(ExplorationTest, WhereTheFallbackFindsNothingAHoldingPolicyComesHomeAndMayChangeItsMind) {
  begin({});
  steps(4);
  EXPECT_GT(told("\"fallback\""), 0u);
  EXPECT_EQ(went_home, "");
  answer = [&](const DecisionRequest&) { return go_to({6, 0, 1}); };
  steps(1);
  EXPECT_TRUE(goals.goal()) << events();
  answer = [](const DecisionRequest&) { return Decision{}; };
  steps(30);
  EXPECT_EQ(went_home, "explored: no frontier can be reached");
}

TEST_F(ExplorationTest, WithoutBatteryForAnyGoalItGoesHomeAtOnce) {
  begin();
  BatteryStatus low;
  low.stamp = now();
  low.seconds_left = onboard.options.mission.home_reserve_s + 1;
  endurance.note(low);
  answer = [](const DecisionRequest&) { return go_to({6, 0, 1}); };
  for (int i = 0; i < 30 && asked == 0; ++i) steps(0.1);
  ASSERT_EQ(asked, 1);
  steps(onboard.options.mission.decision_budget_s + 0.2);
  EXPECT_EQ(went_home, "what is left is too far for the battery");
}

// It named both: "too far for the battery, or for the time allowed".
TEST_F(ExplorationTest, WithoutTimeForAnyGoalItGoesHomeAtOnce) {
  begin();
  endurance = Endurance(seconds(now()) + onboard.options.mission.home_reserve_s + 1);
  BatteryStatus full;
  full.stamp = now();
  full.seconds_left = 600;
  endurance.note(full);
  answer = [](const DecisionRequest&) { return go_to({6, 0, 1}); };
  for (int i = 0; i < 30 && asked == 0; ++i) steps(0.1);
  steps(onboard.options.mission.decision_budget_s + 0.2);
  EXPECT_EQ(went_home, "what is left is too far for the time allowed");
}

TEST_F(ExplorationTest, ThePolicyIsToldWhatIsLeftOfBatteryAndMission) {
  begin();
  BatteryStatus battery;
  battery.stamp = now();
  battery.fraction_left = 0.5;
  battery.seconds_left = 1000;
  endurance.note(battery);
  DecisionRequest seen;
  answer = [&](const DecisionRequest& r) {
    seen = r;
    return Decision{};
  };
  for (int i = 0; i < 30 && asked == 0; ++i) steps(0.1);
  ASSERT_EQ(asked, 1);
  EXPECT_EQ(seen.battery_fraction, 0.5);
  EXPECT_EQ(seen.battery_seconds_left, 1000);
  EXPECT_EQ(seen.mission_seconds_left, endurance.mission_seconds_left(seen.stamp));
  EXPECT_GT(seen.mission_seconds_left, 0);
}

TEST_F(ExplorationTest, WhileTheSupervisorHoldsItNoPatienceRunsOut) {
  begin();
  answer = [](const DecisionRequest&) { return explored(); };
  steps(3);
  path.obey(SafetyAction::brake);
  steps(10);
  path.obey(SafetyAction::none);
  steps(2);
  EXPECT_EQ(went_home, "");
  steps(5);
  EXPECT_EQ(went_home, "explored: all seen");
}

TEST_F(ExplorationTest, WhatWasDecidedBeforeABrakeIsNotFlown) {
  begin();
  answer = [&](const DecisionRequest&) { return go_to({6, 0, 1}); };
  for (int i = 0; i < 30 && asked == 0; ++i) steps(0.1);
  ASSERT_EQ(asked, 1);
  path.brake(now());
  advance(onboard.options.mission.decision_budget_s + 0.05);
  EXPECT_FALSE(goals.goal());
  EXPECT_TRUE(claimed.empty());
  EXPECT_EQ(told("\"decision\""), 1u) << "it is recorded all the same";
}

TEST_F(ExplorationTest, NobodyIsAskedWhileTheSupervisorHoldsItOrAnotherVehicleGoesFirst) {
  begin();
  path.obey(SafetyAction::brake);
  steps(5);
  EXPECT_EQ(asked, 0);
  path.obey(SafetyAction::none);
  path.yield(true);
  steps(5);
  EXPECT_EQ(asked, 0);
  path.yield(false);
  steps(1.5);
  EXPECT_GT(asked, 0);
}

TEST_F(ExplorationTest, AGoalWithoutProgressIsAbandoned) {
  begin();
  answer = [&](const DecisionRequest&) { return asked == 1 ? go_to({6, 0, 1}) : Decision{}; };
  steps(1.0);
  ASSERT_TRUE(goals.goal()) << events();
  onboard.flight.brake(now());
  path.block();  // it stands before a closed place, and no other way is found
  answer = [&](const DecisionRequest&) { return go_to({6, 0, 1}); };
  for (double t = 0; t < 2 * onboard.options.mission.goal_timeout_s && goals.goal(); t += 0.1) {
    exploration.step();
    advance(0.1);
    onboard.flight.brake(now());
    path.block();
  }
  EXPECT_EQ(told("no progress towards it"), 1u);
}

}  // namespace
}  // namespace karst::core
