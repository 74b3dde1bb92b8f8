// The rules of a team: when to turn home, and what a robot makes of what it heard.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "core_stack/common/error.h"
#include "core_stack/common/random.h"
#include "core_stack/homing/path_home/home.h"
#include "core_stack/team/team_node.h"
#include "tests/unit/team/communication/test_radio.h"

namespace karst::core {
namespace {

TEST(HomingMargin, IsMeanAndQuantileOfTheNormalDistribution) {
  HomingOptions o;
  o.flown_mean = 0.87, o.flown_deviation = 0.04;
  for (const auto& [p, z] : {std::pair{0.5, 0.0},
                             {0.8413447460685429, 1.0},
                             {0.99, 2.3263478740408408},
                             {0.999, 3.090232306167813}}) {
    o.arrival_probability = p;
    EXPECT_NEAR(homing_margin(o), 0.87 + z * 0.04 - 1, 1e-9) << p;
  }
}

TEST(HomingMargin, IsKeptByTheShareOfFlightsThatWasAskedFor) {
  HomingOptions o;
  o.arrival_probability = 0.9;
  o.flown_mean = 0.95, o.flown_deviation = 0.1;
  Random random(5);
  constexpr int kFlights = 20000;
  constexpr double kEstimate_s = 80, kReserve_s = 15;
  // It turns home at the last moment that the rule allows.
  const double seconds_left = kEstimate_s * (1 + homing_margin(o)) + kReserve_s;
  EXPECT_NEAR(home_slack_s(seconds_left, kEstimate_s, homing_margin(o), kReserve_s), 0, 1e-9);
  int arrived = 0;
  for (int i = 0; i < kFlights; ++i) {
    const double flown_s = kEstimate_s * (o.flown_mean + o.flown_deviation * random.normal());
    arrived += flown_s <= seconds_left - kReserve_s;
  }
  EXPECT_NEAR(static_cast<double>(arrived) / kFlights, 0.9, 0.01);  // five standard deviations
}

TEST(TeamOptions, ThatDoNotFitTogetherAreRefusedByName) {
  TeamOptions team;
  HomingOptions homing;
  team.robots = 3;
  EXPECT_NO_THROW(check(team, homing, "mission.info"));
  team.robots = team.nodes = 1;
  EXPECT_THROW(check(team, homing, "mission.info"), InputError) << "no team";
  team.robots = 5, team.nodes = 5;  // 30 radios and the base's
  EXPECT_NO_THROW(check(team, homing, "mission.info"));
  team.nodes = 6;
  EXPECT_THROW(check(team, homing, "mission.info"), InputError) << "35 radios";
  team.nodes = 0;
  homing.tree.longest_edge_m = homing.tree.min_edge_m;
  EXPECT_THROW(check(team, homing, "mission.info"), InputError);
}

/// Teammates that hear each other as `linked` says.
struct Team {
  std::vector<TeamNode> nodes;
  std::function<bool(RobotId, RobotId)> linked = [](RobotId, RobotId) { return true; };
  TimeNs now = 0;

  explicit Team(RobotId robots) {
    TeamOptions options;
    options.robots = robots;
    for (RobotId r = 0; r <= robots; ++r)
      nodes.emplace_back(r, options, HomingOptions{}, Vec3(1, 2, 3), 7, testing::test_key());
  }
  void run(double for_s) {
    for (const TimeNs end = now + from_seconds(for_s); now < end;) {
      now += kSecond / 10;
      for (TeamNode& from : nodes) {
        TeamState state = states[from.self()];
        state.stamp = now;
        from.set_state(state);
        for (const Bytes& frame : from.transmit(now))
          for (TeamNode& to : nodes)
            if (to.self() != from.self() && linked(from.self(), to.self())) to.receive(frame, now);
      }
    }
  }
  void land(RobotId r, const Vec3& ground) {
    TreeFacts node;
    node.nodes = {{{r, 1}, NodeKind::communication, ground + Vec3(0, 0, 1)}};
    nodes[r].publish(node);
    nodes[r].publish(LandingClaim{now, ground, ground + Vec3(0, 0, 1), LandingClaim::State::landed});
  }
  std::vector<RobotId> relays_of(RobotId r) const {
    std::vector<RobotId> out;
    for (const Relay& relay : nodes[r].relays()) out.push_back(relay.robot);
    return out;
  }
  std::array<TeamState, kMaxRobots> states{};
};

TEST(TeamNode, CountsOnRelaysThatReachedTheBaseWhenLastHeardOf) {
  Team team(3);
  // A chain: base - 1 - 2; robot 3 hears robot 2 for half a minute, and then nobody.
  bool with_3 = true;
  team.linked = [&](RobotId a, RobotId b) {
    if (a == 3 || b == 3) return with_3 && a + b == 5;
    return a + 1 == b || b + 1 == a;
  };
  team.land(1, {40, 0, 0});
  team.land(2, {80, 0, 0});
  team.run(30);
  EXPECT_EQ(team.relays_of(3), (std::vector<RobotId>{0, 1, 2}));
  EXPECT_TRUE(team.nodes[3].base_in_contact(team.now, 0));
  with_3 = false;
  team.run(3);
  EXPECT_TRUE(team.nodes[3].base_in_contact(team.now, 0)) << "some seconds of silence are chance";
  EXPECT_FALSE(team.nodes[3].base_in_contact(team.now, team.now - kSecond))
      << "but not heard where it is now";
  team.run(117);
  EXPECT_FALSE(team.nodes[3].base_in_contact(team.now, 0)) << "by what is heard now";
  EXPECT_EQ(team.relays_of(3), (std::vector<RobotId>{0, 1, 2})) << "by older news";
}

// As it was: a node that its robot had dropped too far out reached the base over that robot, which flew on
// and believed so ever after.
TEST(TeamNode, WhoReachesTheBaseOverOneInTheAirOnlyIsNotCountedOn) {
  Team team(3);
  bool landed_in_range = false;
  using Pair = std::pair<RobotId, RobotId>;
  team.linked = [&](RobotId a, RobotId b) {  // base - 3, in the air - 2, landed - 1
    const Pair pair(std::min(a, b), std::max(a, b));
    return pair == Pair(0, 3) || pair == Pair(2, 3) || pair == Pair(1, 2) ||
           (landed_in_range && pair == Pair(0, 2));
  };
  team.states[3].phase = TeamPhase::explore;
  team.land(2, {80, 0, 0});
  team.run(30);
  EXPECT_TRUE(team.nodes[1].landing_of(2)) << "news pass";
  EXPECT_EQ(team.relays_of(1), (std::vector<RobotId>{0}));
  EXPECT_FALSE(team.nodes[1].base_in_contact(team.now, 0));
  landed_in_range = true;
  team.run(30);
  EXPECT_EQ(team.relays_of(1), (std::vector<RobotId>{0, 2}));
  EXPECT_TRUE(team.nodes[1].base_in_contact(team.now, 0));
}

TEST(TeamNode, KnowsARelayThatFellSilentForDeadAndOneThatComesBackForAlive) {
  Team team(3);
  bool dead = false;
  team.linked = [&](RobotId a, RobotId b) { return !dead || (a != 1 && b != 1); };
  team.land(1, {40, 0, 0});
  team.run(20);
  ASSERT_EQ(team.relays_of(3), (std::vector<RobotId>{0, 1}));
  dead = true;
  team.run(30);
  EXPECT_TRUE(team.nodes[3].reported_dead(1)) << "the base stood by and told";
  EXPECT_EQ(team.relays_of(3), (std::vector<RobotId>{0}));
  dead = false;
  team.run(30);
  EXPECT_EQ(team.relays_of(3), (std::vector<RobotId>{0, 1}));
}

// As it was: who met one that had passed the relay knew of its landing at once, of its links six seconds
// later, and turned home in between for want of any relay.
TEST(TeamNode, ARelayThatWasCountedOnStaysOneWhileTheNewsOfItsLandingComeInPieces) {
  Team team(4);
  team.states[2].phase = team.states[3].phase = team.states[4].phase = TeamPhase::explore;
  team.states[2].seconds_left = 60;
  team.land(1, {40, 0, 0});
  team.run(20);
  team.nodes[2].publish(LandingClaim{team.now, {80, 0, 0}, {80, 0, 1}, LandingClaim::State::claimed});
  team.run(5);
  ASSERT_EQ(team.relays_of(3), (std::vector<RobotId>{0, 1, 2})) << "the last is on its way down";
  team.linked = [](RobotId a, RobotId b) { return a != 3 && b != 3 && (a + 1 == b || b + 1 == a); };
  team.states[2].phase = TeamPhase::relay;
  team.land(2, {80, 0, 0});
  team.run(60);
  team.linked = [](RobotId a, RobotId b) { return a != 4 && b != 4 && (a + 1 == b || b + 1 == a); };
  // The record of the landing before all else: what is known of robot 2 else dates from when it flew.
  Frame first{.sender = 2, .sent = team.now};
  const LandingClaim landed{team.now - 60 * kSecond, {80, 0, 0}, {80, 0, 1}, LandingClaim::State::landed};
  first.records = {{2, team.nodes[3].gossip().held(2).first() + 1, *write_record(landed)}};
  TeamNode with_record = team.nodes[3];
  with_record.receive(*testing::write_frame(first), team.now);
  ASSERT_EQ(with_record.landing_of(2)->state, LandingClaim::State::landed);
  EXPECT_EQ(with_record.relays().size(), 3u);
  EXPECT_FALSE(with_record.relays().back().stands_by) << "it stands";
  for (int i = 0; i < 150; ++i) {
    team.run(0.1);
    ASSERT_EQ(team.relays_of(3), (std::vector<RobotId>{0, 1, 2})) << i;
  }
  EXPECT_EQ(team.nodes[3].landing_of(2)->state, LandingClaim::State::landed) << "it has heard of it";
}

// As it was: ten records a second, for as long as they went on.
TEST(TeamNode, RelaysThatHearAnotherAndThatDoNotDoNotArgueAboutIt) {
  Team team(3);
  bool lost = false;  // by robot 1 alone
  team.linked = [&](RobotId a, RobotId b) { return !lost || a + b != 4 || a == b; };
  for (RobotId r = 1; r <= 3; ++r) team.land(r, {10.0 * r, 0, 0});
  team.run(20);
  lost = true;
  const auto reported = [&] {
    std::uint32_t all = 0;
    for (RobotId r = 0; r <= 2; ++r) all += team.nodes[r].gossip().held(r).first();
    return all;
  };
  const std::uint32_t before = reported();
  team.run(120);
  EXPECT_FALSE(team.nodes[1].reported_dead(3)) << "robot 2 and the base hear it";
  EXPECT_EQ(team.relays_of(1), (std::vector<RobotId>{0, 2, 3}));
  EXPECT_LE(reported() - before, 60u + 4u) << "a receipt every two seconds, and once dead and alive";
}

TEST(TeamNode, WithALandedRelayThatTheBaseCannotHearDoesNotCountOnIt) {
  Team team(2);
  team.linked = [](RobotId a, RobotId b) { return a != kBase && b != kBase; };
  team.land(1, {200, 0, 0});
  team.run(20);
  EXPECT_EQ(team.relays_of(2), (std::vector<RobotId>{0}));
  EXPECT_FALSE(team.nodes[2].base_in_contact(team.now, 0));
}

TEST(TeamNode, CountsLastOnOneThatIsOnItsWayToAClaimedPlace) {
  Team team(2);
  team.states[1].phase = TeamPhase::home;
  team.states[1].seconds_left = 80;
  team.run(1);
  team.nodes[1].publish(LandingClaim{team.now, {40, 0, 0}, {40, 0, 1}, LandingClaim::State::claimed});
  team.run(5);
  std::vector<Relay> relays = team.nodes[2].relays();
  ASSERT_EQ(relays.size(), 2u);
  EXPECT_FALSE(relays[0].stands_by);
  EXPECT_EQ(relays[1].robot, 1);
  ASSERT_TRUE(relays[1].stands_by);
  EXPECT_NEAR(seconds(*relays[1].stands_by - team.now), 80, 2);
  team.nodes[1].publish(LandingClaim{team.now, {40, 0, 0}, {40, 0, 1}, LandingClaim::State::given_up});
  team.run(5);
  EXPECT_EQ(team.nodes[2].relays().size(), 1u);
}

TEST(TeamNode, OfTwoThatClaimOnePlaceTheLaterIsOverruled) {
  Team team(2);
  team.run(1);
  team.nodes[2].publish(LandingClaim{team.now, {40, 0, 0}, {40, 0, 1}, LandingClaim::State::claimed});
  team.run(0.1);
  team.nodes[1].publish(LandingClaim{team.now, {41, 0, 0}, {41, 0, 1}, LandingClaim::State::claimed});
  team.run(5);
  EXPECT_TRUE(team.nodes[1].overruled()) << "its number is lower, but its claim came later";
  EXPECT_FALSE(team.nodes[2].overruled());
}

// As it was: places were chosen 2 m apart, and given up if they were nearer than 3 m.
TEST(TeamNode, AClaimAsFarFromAnothersAsPlacesAreChosenIsNotOverruled) {
  Team team(2);
  team.run(1);
  const double apart_m = HomingOptions{}.landing.separation_m + 0.02;
  ASSERT_LT(apart_m, TeamOptions{}.separation_m);
  team.nodes[1].publish(LandingClaim{team.now, {40, 0, 0}, {40, 0, 1}, LandingClaim::State::claimed});
  team.run(1);
  team.nodes[2].publish(
      LandingClaim{team.now, {40 + apart_m, 0, 0}, {40 + apart_m, 0, 1}, LandingClaim::State::claimed});
  team.run(5);
  EXPECT_FALSE(team.nodes[2].overruled());
}

TEST(TeamNode, ForgetsGoalsThatWereGivenUpOrClaimedLongAgo) {
  Team team(2);
  team.nodes[1].publish(GoalClaim{team.now, {5, 0, 0}, false});
  team.run(5);
  EXPECT_EQ(team.nodes[2].claimed_goals(team.now).size(), 1u);
  EXPECT_TRUE(team.nodes[1].claimed_goals(team.now).empty()) << "its own";
  EXPECT_TRUE(team.nodes[2].claimed_goals(team.now + from_seconds(TeamOptions{}.claim_age_s)).empty());
  team.nodes[1].publish(GoalClaim{team.now, {5, 0, 0}, true});
  team.run(5);
  EXPECT_TRUE(team.nodes[2].claimed_goals(team.now).empty());
}

TEST(TeamNode, KnowsAllThatHaveStartedAsTheyWereLastHeardOf) {
  Team team(4);
  team.states[1].phase = TeamPhase::explore;
  team.states[1].seconds_left = 120;
  team.states[1].position = {9, 0, 0};
  team.states[3].phase = TeamPhase::standby;
  team.states[4].phase = TeamPhase::landed;
  team.nodes[1].publish(GoalClaim{team.now, {12, 0, 0}, false});
  team.nodes[4].publish(GoalClaim{team.now, {5, 0, 0}, false});
  team.run(3);
  const TimeNs last_heard = team.now;
  team.linked = [](RobotId, RobotId) { return false; };
  team.run(30);
  const std::vector<TeammateState> teammates = team.nodes[2].teammates(team.now);
  ASSERT_EQ(teammates.size(), 2u) << "robot 3 has not started";
  EXPECT_EQ(teammates[0].robot, 1);
  EXPECT_TRUE(teammates[0].explores);
  EXPECT_NEAR(seconds(last_heard - teammates[0].heard), 0.5, 1.0);
  EXPECT_EQ(teammates[0].position, Vec3(9, 0, 0)) << "where it was, not where it may be by now";
  EXPECT_EQ(teammates[0].goal, Vec3(12, 0, 0));
  EXPECT_EQ(teammates[0].seconds_left, 120);
  EXPECT_EQ(teammates[1].robot, 4);
  EXPECT_FALSE(teammates[1].explores);
  EXPECT_FALSE(teammates[1].goal) << "it flies nowhere any more";
  const auto later = team.nodes[2].teammates(team.now + from_seconds(TeamOptions{}.claim_age_s));
  EXPECT_FALSE(later[0].goal) << "claimed long ago";
}

TEST(TeamNode, SeesVehiclesInTheAirWhereTheyShouldBeByNow) {
  Team team(3);
  team.states[1].phase = TeamPhase::home;
  team.states[1].velocity_mps = {1, 0, 0};
  team.states[3].phase = TeamPhase::standby;
  team.run(3);
  const auto others = team.nodes[2].neighbours(team.now + kSecond);
  ASSERT_EQ(others.size(), 1u) << "robot 3 has not started";
  EXPECT_EQ(others[0].robot, 1);
  EXPECT_GE(others[0].position.x(), 1.0);
  EXPECT_LE(others[0].position.x(), 2.5);  // told at most a period and a half ago
  EXPECT_GE(others[0].age_s, 1.0);
  EXPECT_TRUE(team.nodes[2].neighbours(team.now + 10 * kSecond).empty());
}

}  // namespace
}  // namespace karst::core
