// The parts of a mission that only a robot of a team has.
#include "core_stack/mission/phases/relay_landing.h"
#include "core_stack/mission/team/right_of_way.h"
#include "core_stack/mission/team/team_sharing.h"
#include "tests/unit/mission/onboard_fixture.h"

namespace karst::core {
namespace {

class TeamPartsTest : public OnboardTest {
 protected:
  TeamPartsTest() {
    onboard.map.while_idle().join(&homing, onboard.options.team.claim_radius_m);
    hover();
    phases.enter(Phase::takeoff, now());
    phases.enter(Phase::explore, now());
  }
  TeamNode teammate(RobotId id) {
    return TeamNode(id, onboard.options.team, onboard.options.homing, Vec3::Zero(), 1, key_of_seed(1));
  }
  /// Robot 1, which goes before robot 2, says that it is there.
  void receive_first_robot_at(const Vec3& place, const Vec3& velocity_mps = Vec3::Zero()) {
    TeamState state;
    state.position = place;
    state.velocity_mps = velocity_mps;
    state.phase = TeamPhase::explore;
    state.stamp = now();
    first.set_state(state);
    for (const Bytes& frame : first.transmit(now())) node.receive(frame, now());
  }
  const Vec3& here() { return onboard.flight.reference().position; }

  TeamNode node = teammate(2), first = teammate(1);
  RelayHoming homing{2,
                     {.team = onboard.options.team,
                      .homing = onboard.options.homing,
                      .planning = onboard.options.planning,
                      .motion = onboard.options.motion,
                      .vehicle_radius_m = onboard.vehicle.radius_m}};
  Teamwork work{node, homing, onboard.options.team, 0};
  TeamSharing sharing{onboard, work, {phases, path, endurance}};
  RightOfWay right_of_way{onboard, work, {phases, goals, path, flown_path}};
  RelayLanding landing{onboard, work, phases, endurance};
};

TEST_F(TeamPartsTest, ItYieldsToARobotThatGoesFirstAndGoesOnOnceThatIsAway) {
  right_of_way.step();
  EXPECT_FALSE(path.yields());
  fly_ahead(20);
  advance(2);
  receive_first_robot_at(here() + Vec3(4, 0, 0), Vec3(-1, 0, 0));
  right_of_way.step();
  EXPECT_TRUE(path.yields());
  EXPECT_TRUE(path.blocked());
  EXPECT_TRUE(path.brakes_since(0));
  EXPECT_EQ(told("give way"), 1u);
  for (int i = 0; i < 300 && path.yields(); ++i) {
    advance(0.1);
    receive_first_robot_at(here() + Vec3(40, 0, 0));
    right_of_way.step();
  }
  EXPECT_FALSE(path.yields());
  EXPECT_EQ(told("go on"), 1u);
}

TEST_F(TeamPartsTest, OnceItLandsNobodyHasTheRightOfWayOverIt) {
  receive_first_robot_at(here() + Vec3(2, 0, 0));
  right_of_way.step();
  ASSERT_TRUE(path.yields());
  phases.enter(Phase::land, now());
  right_of_way.step();
  EXPECT_FALSE(path.yields());
  EXPECT_EQ(right_of_way.phase_to_report(), TeamPhase::landing);
}

TEST_F(TeamPartsTest, AnotherIsInCompanyNearByAndLeftOutOfTheMapWhereItShouldBe) {
  EXPECT_FALSE(sharing.in_company());
  receive_first_robot_at(here() + Vec3(5, 0, 0), Vec3(1, 0, 0));
  EXPECT_TRUE(sharing.in_company());
  const auto bodies = sharing.others_at(now() - kSecond / 2);
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_NEAR(bodies[0].position.x() - here().x(), 4.5, 0.03) << "half a second ago, at 1 m/s";
  advance(1);
  receive_first_robot_at(here() + Vec3(50, 0, 0));
  EXPECT_FALSE(sharing.in_company());
}

TEST_F(TeamPartsTest, ItStaysOnTheGroundWhileAnotherIsWhereItWouldHover) {
  EXPECT_TRUE(sharing.airspace_clear());
  receive_first_robot_at(Vec3(1, 0, 1));
  EXPECT_FALSE(sharing.airspace_clear());
}

TEST_F(TeamPartsTest, ItStaysOnTheGroundWhileAnotherComesHomeOrMayHaveComeUnheard) {
  const auto hear_at = [this](const Vec3& place, TeamPhase phase) {
    TeamState state;
    state.position = place, state.phase = phase, state.stamp = now();
    first.set_state(state);
    for (const Bytes& frame : first.transmit(now())) node.receive(frame, now());
  };
  hear_at({6, 0, 1}, TeamPhase::explore);
  EXPECT_TRUE(sharing.airspace_clear());
  advance(5);
  EXPECT_FALSE(sharing.airspace_clear()) << "it was near, and is silent";
  advance(8);
  EXPECT_TRUE(sharing.airspace_clear()) << "who knows where it is by now";
  hear_at({8, 0, 1}, TeamPhase::home);
  EXPECT_FALSE(sharing.airspace_clear());
}

// As it was: it flew at another that it saw, and did not hear, as if that were rock.
TEST_F(TeamPartsTest, ItYieldsToAVehicleThatItSeesAndDoesNotHear) {
  fly_ahead(20);
  advance(2);
  for (int i = 0; i < 10; ++i) {
    advance(0.1);
    work.note_seen(std::vector<Vec3>{Vec3(12 - 0.15 * i, 0, here().z())}, now());
  }
  right_of_way.step();
  EXPECT_TRUE(path.yields());
  EXPECT_TRUE(path.brakes_since(0));
  const auto bodies = sharing.others_at(now());
  ASSERT_EQ(bodies.size(), 1u) << "it leaves no ghost in the map";
  advance(5);
  right_of_way.step();
  EXPECT_FALSE(path.yields()) << "it is out of sight";
}

// As it was: one that made room went before the other all the way home, both as slow as they pass each other.
TEST_F(TeamPartsTest, ItFliesSlowlyNearOneThatItDoesNotHearUnlessItFliesAwayFromIt) {
  fly_ahead(30);
  advance(4);
  for (const double ahead_m : {4.0, -4.0}) {
    for (int i = 0; i < 10; ++i) {
      advance(0.1);
      const Vec3 to_other = Vec3(ahead_m, 0.5, 0);
      work.note_seen(std::vector<Vec3>{onboard.flight.state().position + to_other}, now());
    }
    right_of_way.step();
    EXPECT_EQ(right_of_way.max_speed_mps().has_value(), ahead_m > 0) << ahead_m;
    advance(5);
    right_of_way.step();
    EXPECT_FALSE(right_of_way.max_speed_mps().has_value()) << "it is out of sight";
  }
}

TEST_F(TeamPartsTest, AClaimedGoalIsToldToTheOthersUntilItIsGivenUp) {
  Goal goal;
  goal.position = {7, 1, 2};
  sharing.claim_goal(goal);
  const auto tell = [this](TeamPhase phase) {
    for (int i = 0; i < 30; ++i) {
      advance(0.1);
      sharing.report(phase);
      for (const Bytes& frame : node.transmit(now())) first.receive(frame, now());
      receive_first_robot_at({30, 0, 0});
    }
  };
  tell(TeamPhase::explore);
  ASSERT_EQ(first.claimed_goals(now()).size(), 1u);
  EXPECT_LT((first.claimed_goals(now())[0] - goal.position).norm(), 0.02);
  sharing.give_up_goals();
  tell(TeamPhase::home);
  EXPECT_TRUE(first.claimed_goals(now()).empty());
}

TEST_F(TeamPartsTest, WithoutARelayNearerThanTheStartItHasNoLandingPlace) {
  phases.enter(Phase::home, now());
  bool over = false, changed = false;
  landing.choose(
      0, [&] { over = true; }, [&] { changed = true; });
  EXPECT_FALSE(over);
  advance(0.3);
  EXPECT_TRUE(over);
  EXPECT_TRUE(changed);
  EXPECT_FALSE(landing.spot());
  EXPECT_EQ(told("no landing place is nearer"), 1u);
}

TEST_F(TeamPartsTest, AChoiceThatComesAfterItBeganToLandChangesNothing) {
  phases.enter(Phase::home, now());
  bool over = false, changed = false;
  landing.choose(
      0, [&] { over = true; }, [&] { changed = true; });
  phases.enter(Phase::land, now());
  advance(0.3);
  EXPECT_TRUE(over);
  EXPECT_FALSE(changed);
}

TEST(ToldPhase, TellsWhoCannotStopForOthers) {
  EXPECT_EQ(phase_for_team(Phase::takeoff), TeamPhase::landing);
  EXPECT_EQ(phase_for_team(Phase::land), TeamPhase::landing);
  EXPECT_EQ(phase_for_team(Phase::look), TeamPhase::explore);
  EXPECT_EQ(phase_for_team(Phase::home), TeamPhase::home);
  EXPECT_EQ(phase_for_team(Phase::done), TeamPhase::landed);
}

}  // namespace
}  // namespace karst::core
