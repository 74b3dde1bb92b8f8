#include "core_stack/mission/onboard/explorer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <set>

#include "core_stack/planning/search/grid_planner.h"
#include "tests/unit/mission/drawn_map.h"

namespace karst::core {
namespace {

/// A policy that does as the test says.
struct Scripted final : PolicyPort {
  std::function<Decision(const DecisionRequest&)> script;
  std::vector<PolicyEvent> heard;
  std::string name() const override { return "scripted"; }
  Decision decide(const DecisionRequest& r) override { return script(r); }
  void notify(const PolicyEvent& e) override { heard.push_back(e); }
};

/// A room with one open side, the vehicle hovering in it.
struct Room {
  Scripted policy;
  VehicleDescription vehicle;
  std::unique_ptr<Explorer> explorer;
  CycleInput input;

  explicit Room(const CoreOptions& options = {}, const Vec3& size = Vec3(8, 6, 4),
                const std::string& open = "x+") {
    auto lidar = std::make_shared<LidarModel>();
    lidar->columns = 8;
    lidar->elevation_rad = {0.5f, -0.5f};
    vehicle.lidar = lidar;
    vehicle.T_world_start.position = Vec3(3, 3, 1);
    explorer = std::make_unique<Explorer>(options, vehicle, policy);
    const std::vector<Ray> rays = box_rays(VoxelMap{MapOptions{}}, Vec3(0, 0, 0), size, {open});
    explorer->integrate(rays);
    input.from = input.state.position = Vec3(3, 3, 2);
    input.seconds_left = 600;
    input.standing = true;
  }
  CycleResult decide(std::function<Decision(const DecisionRequest&)> script) {
    policy.script = std::move(script);
    return explorer->decide(input);
  }
  CycleResult propose(const Vec3& p) {
    return decide([p](const DecisionRequest&) {
      Decision d;
      d.outcome = Outcome::goals;
      d.goals.resize(1);
      d.goals[0].position = p;
      return d;
    });
  }
};

TEST(Explorer, OffersTheOpenSideWithAReachableViewpoint) {
  Room room;
  bool some_reachable = false;
  room.decide([&](const DecisionRequest& r) {
    for (const FrontierOffer& o : r.frontiers) {
      some_reachable = some_reachable || std::isfinite(o.path_length_m);
      EXPECT_NEAR(o.cluster->centroid.x(), 7.9, 0.2);
    }
    return Decision{};
  });
  EXPECT_TRUE(some_reachable);
}

TEST(Explorer, PlansAPathInKnownFreeSpaceToAnAcceptedGoal) {
  Room room;
  const CycleResult r = room.propose(Vec3(6.5, 4, 2));
  ASSERT_TRUE(r.goal);
  ASSERT_GE(r.path.points.size(), 2u);
  EXPECT_TRUE(r.path.points.front().isApprox(room.input.from));
  EXPECT_LT((r.path.points.back() - Vec3(6.5, 4, 2)).norm(), 0.2);
  EXPECT_EQ(room.explorer->blocked_segment(r.path.points, {}), -1);
}

TEST(Explorer, EveryRefusalHasAReasonAndReachesThePolicy) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::pair<Vec3, std::string> bad[] = {{Vec3(nan, 0, 0), "not finite"},
                                              {Vec3(50, 50, 50), "unknown space"},
                                              {Vec3(0.1, 3, 2), "occupied"},
                                              {Vec3(0.5, 3, 2), "too near"}};
  for (const auto& [place, reason] : bad) {
    Room room;
    const CycleResult r = room.propose(place);
    EXPECT_FALSE(r.goal);
    ASSERT_EQ(r.rejected.size(), 1u);
    EXPECT_NE(r.rejected[0].reason.find(reason), std::string::npos) << r.rejected[0].reason;
    ASSERT_EQ(room.policy.heard.size(), 1u);
    EXPECT_EQ(room.policy.heard[0].kind, PolicyEvent::Kind::goal_rejected);
  }
}

TEST(Explorer, RefusesAGoalTheBatteryDoesNotAllow) {
  Room room;
  room.input.seconds_left = 21;  // just over the reserve
  const CycleResult r = room.propose(Vec3(6.5, 4, 2));
  ASSERT_GT(r.rejected.size(), 1u) << "the fallback's goals, too, in the same round";
  for (const RejectedGoal& goal : r.rejected) EXPECT_NE(goal.reason.find("battery"), std::string::npos);
  EXPECT_EQ(r.outcome, Outcome::explored);
  EXPECT_EQ(room.policy.heard.size(), 1u) << "the policy is told of its own goals";
}

TEST(Explorer, TheFirstGoalThatPassesIsTaken) {
  Room room;
  const CycleResult r = room.decide([](const DecisionRequest&) {
    Decision d;
    d.outcome = Outcome::goals;
    d.goals.resize(3);
    d.goals[0].position = Vec3(50, 50, 50);
    d.goals[1].position = Vec3(5, 3, 2);
    d.goals[2].position = Vec3(4, 3, 2);
    return d;
  });
  ASSERT_TRUE(r.goal);
  EXPECT_TRUE(r.goal->position.isApprox(Vec3(5, 3, 2)));
  EXPECT_EQ(r.rejected.size(), 1u);
}

TEST(Explorer, AFailedPolicyIsReplacedByTheFallbackForGood) {
  Room room;
  int asked = 0;
  const auto fail = [&](const DecisionRequest&) -> Decision {
    ++asked;
    throw PolicyFailure("it hangs");
  };
  for (int i = 0; i < 3; ++i) {
    const CycleResult r = room.decide(fail);
    EXPECT_EQ(r.policy, "fallback");
    EXPECT_TRUE(r.goal) << "the fallback finds the open side";
  }
  EXPECT_EQ(asked, 1);
}

TEST(Explorer, APolicyThatOnlyProposesTheImpossibleIsPassedOverForARound) {
  Room room;
  int fallback_cycles = 0;
  for (int i = 0; i < 10; ++i) {
    room.input.now = i * kSecond;
    fallback_cycles += room.propose(Vec3(50, 50, 50)).policy == "fallback";
  }
  EXPECT_EQ(fallback_cycles, 3);
}

TEST(Explorer, APolicyMayHoldAStandingVehicleForTwoSecondsAndNoLonger) {
  // As it was: a policy that now held, now proposed what had to be refused, held the vehicle for 14 s.
  Room room;
  const auto hold = [](const DecisionRequest&) { return Decision{}; };
  for (int cycle = 0; cycle < 4; ++cycle) {
    room.input.now = cycle * kSecond / 2;
    EXPECT_EQ((cycle == 2 ? room.propose(Vec3(50, 50, 50)) : room.decide(hold)).policy, "scripted") << cycle;
  }
  room.input.now = 2 * kSecond;
  EXPECT_EQ(room.decide(hold).policy, "fallback");
}

TEST(Explorer, APolicyThatSaysExploredIsNotOverruledThoughFrontiersAreLeft) {
  Room room;
  for (int cycle = 0; cycle < 20; ++cycle) {
    room.input.now = cycle * kSecond / 2;
    const CycleResult r = room.decide([](const DecisionRequest& request) {
      EXPECT_FALSE(request.frontiers.empty());
      Decision d;
      d.outcome = Outcome::explored;
      return d;
    });
    EXPECT_EQ(r.outcome, Outcome::explored) << cycle;
    EXPECT_EQ(r.policy, "scripted") << cycle;
  }
}

TEST(Explorer, WhereTheFallbackFindsNothingThePolicyIsStillAskedFirst) {
  Room room({}, Vec3(8, 6, 4), "");  // closed: no frontier at all
  int asked = 0;
  const auto hold = [&](const DecisionRequest&) {
    ++asked;
    return Decision{};
  };
  EXPECT_EQ(room.decide(hold).outcome, Outcome::hold);
  room.input.now = 2 * kSecond;
  EXPECT_EQ(room.decide(hold).policy, "fallback");
  EXPECT_EQ(asked, 1);
  room.input.now = 3 * kSecond;
  const CycleResult both = room.decide(hold);
  EXPECT_EQ(asked, 2);
  EXPECT_EQ(both.outcome, Outcome::explored) << "the policy's hold does not hide that nothing is left";
  EXPECT_EQ(both.policy, "fallback");
  room.input.now = 4 * kSecond;
  const CycleResult own = room.propose(Vec3(6.5, 4, 2));
  EXPECT_TRUE(own.goal) << "a place of its own that the fallback knows nothing of";
  EXPECT_EQ(own.policy, "scripted");
  room.input.now = 5 * kSecond;
  EXPECT_EQ(room.decide(hold).outcome, Outcome::hold) << "the vehicle has been busy: two seconds begin anew";
}

CoreOptions narrow_allowed() {
  CoreOptions options;
  options.planning.narrow_margin_m = 0.08;
  return options;
}

TEST(Explorer, AskedTwiceInARoundItReportsEachFrontierOnce) {
  // As it was: those of the round's second asking, for narrow passages, came on top of the first one's.
  Room room(narrow_allowed());
  int asked = 0;
  const CycleResult r = room.decide([&](const DecisionRequest&) {
    ++asked;
    Decision d;
    d.outcome = Outcome::explored;
    return d;
  });
  EXPECT_EQ(asked, 2);
  std::set<std::uint32_t> ids;
  for (const FrontierCluster& c : r.frontiers) EXPECT_TRUE(ids.insert(c.id).second) << c.id;
  EXPECT_FALSE(ids.empty());
}

TEST(Explorer, APolicyThatIsPassedOverIsSoForNarrowPassagesToo) {
  // As it was: passed over for wide passages, it was asked for narrow ones in the same round, and its hold
  // counted. A chimney: its end is in sight, but no climb leads there that the sensors could look along.
  Room room(narrow_allowed(), Vec3(8, 6, 20), "z+");
  int asked = 0;
  const auto hold = [&](const DecisionRequest& r) {
    ++asked;
    EXPECT_TRUE(std::any_of(r.frontiers.begin(), r.frontiers.end(),
                            [](const FrontierOffer& o) { return std::isfinite(o.path_length_m); }));
    return Decision{};
  };
  EXPECT_EQ(room.decide(hold).policy, "scripted");
  room.input.now = 2 * kSecond;
  CycleResult r = room.decide(hold);
  EXPECT_EQ(r.policy, "fallback");
  EXPECT_FALSE(r.rejected.empty()) << "wide passages came first";
  EXPECT_EQ(asked, 1);
  // As it was: with the first five goals refused the cave counted as explored, whatever else was on the list.
  EXPECT_EQ(r.outcome, Outcome::hold) << r.reason;
  for (int i = 0; i < 200 && r.outcome != Outcome::explored; ++i) {
    room.input.now += kSecond / 2;
    r = room.decide(hold);
  }
  EXPECT_EQ(r.outcome, Outcome::explored) << "but it comes to an end";
}

TEST(Explorer, WithoutAKnownWayHomeTheWayComeCounts) {
  // As it was: no way home took no time at all, and every goal was affordable.
  Room room;
  room.explorer = std::make_unique<Explorer>(CoreOptions{}, room.vehicle, room.policy);
  room.input.flown_length_m = 160;
  room.decide([](const DecisionRequest& r) {
    EXPECT_LT(r.seconds_before_homing, 600 - 100 * 1.15 - 20);  // 160 m at 1.6 m/s
    return Decision{};
  });
}

TEST(Explorer, TheWayBackLeavesOutLoopsAndCutsNoCorner) {
  // A U around a wall: its ends are a metre apart, with rock between.
  Room room;
  std::vector<Vec3> flown;
  for (double x = 1; x < 6; x += 0.25) flown.push_back({x, 1.4, 2});
  for (double y = 1.4; y < 2.4; y += 0.25) flown.push_back({6, y, 2});
  for (double x = 6; x > 1; x -= 0.25) flown.push_back({x, 2.4, 2});
  const double free_m = path_length_m(room.explorer->path_back(flown));
  EXPECT_LT(free_m, 5);  // straight over, then home
  std::vector<Ray> wall;
  for (double x = 0.5; x < 5; x += 0.1)
    for (double z = 0.5; z < 3.5; z += 0.1)
      for (int i = 0; i < 3; ++i) {
        const Vec3f origin(static_cast<float>(x), 1.2f, static_cast<float>(z));
        wall.push_back({origin, origin + Vec3f(0, 0.7f, 0), true});
      }
  room.explorer->integrate(wall);
  const std::vector<Vec3> back = room.explorer->path_back(flown);
  EXPECT_GT(path_length_m(back), 9);
  for (std::size_t i = 1; i + 1 < back.size(); ++i)
    EXPECT_TRUE((back[i] - back[i - 1]).norm() < 0.26 ||
                !room.explorer->map().first_not_free(back[i - 1], back[i]));
}

TEST(Explorer, ThePolicyIsToldOfTeammatesAndWhatTimeTheyHaveLeft) {
  Room room;
  room.input.now = 50 * kSecond;
  const TimeNs heard = 40 * kSecond;
  room.input.teammates = {{1, heard, {6, 4, 2}, {0.5, 0, 0}, Vec3(6.5, 3, 2), true, 300},
                          {2, heard, {6, 4, 2}, {0, 0, 0}, std::nullopt, false, 300},
                          {3, heard, {90, 4, 2}, {0, 0, 0}, std::nullopt, true, 300}};
  std::vector<OtherVehicle> told;
  double own_s = 0;
  const auto ask = [&](const DecisionRequest& r) {
    told = r.teammates, own_s = r.seconds_before_homing;
    return Decision{};
  };
  room.decide(ask);
  ASSERT_EQ(told.size(), 3u);
  EXPECT_EQ(told[0].id, 1u);
  EXPECT_EQ(told[0].heard, heard);
  EXPECT_EQ(told[0].position, Vec3(6, 4, 2));
  EXPECT_EQ(told[0].goal, Vec3(6.5, 3, 2));
  EXPECT_EQ(told[1].seconds_before_homing, 0) << "it explores no more";
  EXPECT_FALSE(told[1].goal);
  EXPECT_TRUE(std::isnan(told[2].seconds_before_homing)) << "it is where this map ends";
  // As for oneself, were one there with as much of the battery left: ten seconds have passed.
  room.input.from = room.input.state.position = Vec3(6, 4, 2);
  room.input.seconds_left = 290;
  room.decide(ask);
  EXPECT_NEAR(told[0].seconds_before_homing, own_s, 1e-9);
  EXPECT_LT(own_s, 290);
}

TEST(Explorer, WhenTheBatteryAllowsNoGoalTheFlightIsOver) {
  // As it was: the policy proposed, the core refused, and the vehicle hovered until the battery called it
  // home.
  Room room;
  room.input.seconds_left = 21;
  Outcome last = Outcome::hold;
  int cycles = 0;
  for (; cycles < 10 && last == Outcome::hold; ++cycles) {
    room.input.now = cycles * kSecond;
    last = room.propose(Vec3(6.5, 4, 2)).outcome;
  }
  EXPECT_EQ(last, Outcome::explored);
  EXPECT_LE(cycles, 5);
}

TEST(Explorer, AnAbandonedGoalIsNotAcceptedAgainWhileTheMapIsUnchanged) {
  Room room;
  const CycleResult first = room.propose(Vec3(6.5, 4, 2));
  ASSERT_TRUE(first.goal);
  room.input.events = {{PolicyEvent::Kind::goal_abandoned, 0, *first.goal, "no progress towards it"}};
  room.input.now = 1000 * kSecond;
  const CycleResult again = room.propose(Vec3(6.5, 4, 2));
  EXPECT_FALSE(again.goal);
  ASSERT_EQ(again.rejected.size(), 1u);
  EXPECT_NE(again.rejected[0].reason.find("no progress"), std::string::npos);
}

TEST(Explorer, RefusesAGoalThatAsksForLessThanTheLeastSpeed) {
  CoreOptions options;
  options.motion.min_speed_mps = 0.3;
  Room room(options);
  const auto at_speed = [&](double speed_mps) {
    return room.decide([speed_mps](const DecisionRequest&) {
      Decision d;
      d.outcome = Outcome::goals;
      d.goals.resize(1);
      d.goals[0].position = Vec3(6.5, 4, 2);
      d.goals[0].max_speed_mps = speed_mps;
      return d;
    });
  };
  for (const double speed_mps : {1e-300, 1e-9, 1e-4, 0.29, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const CycleResult r = at_speed(speed_mps);
    EXPECT_FALSE(r.goal) << speed_mps;
    ASSERT_EQ(r.rejected.size(), 1u);
    EXPECT_NE(r.rejected[0].reason.find("below motion.min_speed, 0.3 m/s"), std::string::npos)
        << r.rejected[0].reason;
  }
  for (const double speed_mps : {0.0, 0.3, 0.5, 1000.0}) EXPECT_TRUE(at_speed(speed_mps).goal) << speed_mps;
}

TEST(Explorer, TakesWhatIsAskedForWhereTheLeastSpeedIsAboveTheGreatest) {
  CoreOptions options;
  options.motion.min_speed_mps = 5;
  options.motion.max_speed_mps = 0.5;
  Room room(options);
  const CycleResult r = room.decide([](const DecisionRequest&) {
    Decision d;
    d.outcome = Outcome::goals;
    d.goals.resize(1);
    d.goals[0].position = Vec3(6.5, 4, 2);
    d.goals[0].max_speed_mps = 0.5;
    return d;
  });
  EXPECT_TRUE(r.goal);
}

}  // namespace
}  // namespace karst::core
