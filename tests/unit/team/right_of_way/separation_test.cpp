// Who gives way, and what a vehicle does until the other is past.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>

#include "core_stack/mission/phases/still_watch.h"
#include "core_stack/team/right_of_way/yield_state.h"

namespace karst::core {
namespace {

using Action = YieldState::Action;

Neighbour any_vehicle(RobotId robot) {
  const auto coordinate = [] { return 0.01 * *rc::gen::inRange(-800, 800); };
  const auto speed = [] { return 0.01 * *rc::gen::inRange(-200, 200); };
  const TeamPhase phase = *rc::gen::element(TeamPhase::explore, TeamPhase::home, TeamPhase::landing,
                                            TeamPhase::aside, TeamPhase::boxed);
  const Vec3 position(coordinate(), coordinate(), coordinate()), velocity_mps(speed(), speed(), speed());
  return {robot, position, velocity_mps, phase, 0, *rc::gen::arbitrary<bool>()};
}

bool stops_for(const Neighbour& self, const Neighbour& other) {
  return !give_way_to({}, self, {other}).empty();
}

RC_GTEST_PROP(SeparationRule, OfTwoOneGoesFirstAndNoThreeWaitInACircle, ()) {
  const Neighbour a = any_vehicle(1), b = any_vehicle(2), c = any_vehicle(3);
  RC_ASSERT(goes_before(a, b) != goes_before(b, a));
  RC_ASSERT(!goes_before(a, a));
  RC_ASSERT(!(goes_before(a, b) && goes_before(b, c) && goes_before(c, a)));
  RC_ASSERT(!(goes_before(c, b) && goes_before(b, a) && goes_before(a, c)));
}

RC_GTEST_PROP(SeparationRule, OfTwoThatAreTooNearOneAtLeastStops, ()) {
  const SeparationRule rule;
  const Neighbour a = any_vehicle(1), b = any_vehicle(2);
  RC_PRE(a.phase != TeamPhase::aside && b.phase != TeamPhase::aside);
  const double d = (a.position - b.position).norm();
  RC_ASSERT((stops_for(a, b) || stops_for(b, a)) == (d < yield_distance_m(rule, a, b)));
  const bool both = stops_for(a, b) && stops_for(b, a);
  RC_ASSERT(both == (closing_mps(a, b) > 0 && d < stop_distance_m(rule, a, b)));
}

TEST(SeparationRule, LeavesTheRoomThatIsNeededToStop) {
  const SeparationRule rule{.distance_m = 3, .reaction_s = 1.5, .own_s = 0.3, .brake_mps2 = 1};
  const auto flying = [](double x, double speed) { return Neighbour{1, {x, 0, 0}, {speed, 0, 0}}; };
  // Head on at 1.2 m/s each: 2.4 m/s until the brake begins, and 2.4^2 / 2 to brake.
  EXPECT_NEAR(yield_distance_m(rule, flying(0, 1.2), flying(9, -1.2)), 3 + 2.4 * 1.5 + 2.88, 1e-9);
  EXPECT_NEAR(stop_distance_m(rule, flying(0, 1.2), flying(9, -1.2)), 1.5 + 2.4 * 0.3 + 2.88, 1e-9);
  EXPECT_NEAR(yield_distance_m(rule, flying(0, -1.2), flying(9, 0)), 3, 1e-9);
}

TEST(SeparationRule, WhoExploresGivesWayToWhoGoesHomeAndBothToWhoLands) {
  const std::array order{TeamPhase::landing, TeamPhase::boxed, TeamPhase::home, TeamPhase::explore,
                         TeamPhase::aside};
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t k = i + 1; k < order.size(); ++k)
      EXPECT_TRUE(goes_before({9, {}, {}, order[i]}, {1, {}, {}, order[k]})) << i << ' ' << k;
}

/// Two in a line, of which `self` is asked ten times a second what it does.
struct Meeting {
  YieldState yield_state;
  Neighbour self{2, {0, 0, 0}}, other{1, {8, 0, 0}, {-1, 0, 0}};
  TimeNs now = 0;
  std::vector<Neighbour> others() const { return {other}; }
  StillWatch still;
  Action step() {
    now += kSecond / 10;
    other.position += 0.1 * other.velocity_mps;
    if (!yield_state.holds()) still.wait(now);  // it was under way
    return yield_state.update({}, self, others(), now, true, still.still_for(self.position, now));
  }
  Action run(double for_s) {
    Action last = Action::go_on;
    for (int i = 0; i < static_cast<int>(10 * for_s); ++i)
      if ((last = step()) == Action::make_room || last == Action::leave) return last;
    return last;
  }
  /// It makes room, and waits where the other can pass.
  void wait_aside() {
    ASSERT_EQ(run(4), Action::make_room);
    yield_state.set_out();
    yield_state.arrived(YieldState::Place::aside, now);
  }
};

TEST(YieldState, MakesRoomForOneThatComesAndWaitsUntilItIsPast) {
  Meeting m;
  m.other.velocity_mps = {-1.5, 0, 0};
  EXPECT_EQ(m.run(4), Action::make_room);
  m.yield_state.set_out();
  EXPECT_EQ(m.run(1), Action::hold) << "on its way";
  m.self.position.y() = 2;  // beside the other's way
  m.yield_state.arrived(YieldState::Place::aside, m.now);
  EXPECT_EQ(m.yield_state.reported(TeamPhase::explore, m.now), TeamPhase::aside);
  while (m.other.position.x() > -3) ASSERT_EQ(m.step(), Action::hold) << m.other.position.x();
  while (m.step() == Action::hold) ASSERT_GT(m.other.position.x(), -8) << "it waits for ever";
  EXPECT_LT(m.other.position.x(), -3);
  EXPECT_EQ(m.yield_state.reported(TeamPhase::explore, m.now), TeamPhase::explore);
}

TEST(YieldState, GoesOnWhenTheOtherDoesNotComeOrIsNoMoreHeard) {
  Meeting m;
  m.other.position = {2.9, 0, 0}, m.other.velocity_mps.setZero();
  EXPECT_EQ(m.run(10), Action::make_room) << "it may want to get by";
  m.yield_state.set_out();
  m.self.position.x() = -4;
  m.yield_state.arrived(YieldState::Place::aside, m.now);
  EXPECT_EQ(m.run(2.9), Action::hold);
  m.self.position.x() = -6;  // it has left, as it must
  EXPECT_EQ(m.run(2.9), Action::hold);
  m.self.position.x() = -8;
  EXPECT_EQ(m.run(5), Action::go_on) << "it stays where it is";

  Meeting silent;
  silent.other.position.x() = 4;
  ASSERT_EQ(silent.run(1), Action::hold);
  EXPECT_EQ(silent.yield_state.update({}, silent.self, {}, silent.now, true, 0), Action::go_on);
}

TEST(YieldState, LeavesAPlaceWhereTheOtherDoesNotGetBy) {
  Meeting m;
  m.wait_aside();
  m.other.velocity_mps.setZero();
  m.other.position = {3.5, 0, 0};
  EXPECT_EQ(m.run(12), Action::leave);
}

// As it was: one that explored around another kept it in one place for half a minute.
TEST(YieldState, NobodyStaysInOnePlaceForLongWhileAnotherFliesAroundIt) {
  Meeting m;
  m.other.position = {2, 0, 0}, m.other.velocity_mps = {0, 0, 0};
  m.wait_aside();
  Action last = Action::hold;
  for (int i = 0; i < 200 && last == Action::hold; ++i) {
    const double a = 0.05 * i;  // round it, now nearer and now farther
    m.other.velocity_mps =
        10 * (Vec3((2 + 0.5 * std::sin(a)) * std::cos(a), 2 * std::sin(a), 0) - m.other.position);
    last = m.step();
  }
  EXPECT_EQ(last, Action::leave);
  EXPECT_LT(m.now, 10 * kSecond);
}

// As it was: in a small hall one set out past another that waited aside, and that one left its place then.
TEST(YieldState, WhoLeavesAPlaceAsideSaysSoFirst) {
  Meeting m;
  m.wait_aside();
  m.other.velocity_mps.setZero();
  TimeNs aside_until = 0;
  while (m.step() != Action::leave) {
    if (m.yield_state.reported(TeamPhase::explore, m.now) == TeamPhase::aside) aside_until = m.now;
    ASSERT_LT(m.now, 20 * kSecond);
  }
  ASSERT_GT(aside_until, 0);
  EXPECT_GE(m.now - aside_until, kSecond) << "the other hears it, and stops";
}

// As it was: who waited for one that it heard did not get out of the way of one that it did not hear.
TEST(YieldState, WhoWaitsForOneThatIsHeardLeavesAnotherThatComesAndIsNot) {
  Meeting m;
  m.other.position = {2.9, 0, 0}, m.other.velocity_mps.setZero();
  ASSERT_EQ(m.step(), Action::hold);
  Neighbour unheard{kMaxRobots, {0, 6, 0}, {0, -1, 0}, TeamPhase::landing, 0, false};
  Action last = Action::hold;
  for (int i = 0; i < 30 && last == Action::hold; ++i) {
    m.now += kSecond / 10;
    unheard.position += 0.1 * unheard.velocity_mps;
    last = m.yield_state.update({}, m.self, {m.other, unheard}, m.now, true, 0);
  }
  EXPECT_EQ(last, Action::leave);
  EXPECT_EQ(m.yield_state.with(), kMaxRobots);
  EXPECT_GT(unheard.position.y(), 3);
}

TEST(YieldState, OneThatComesAndIsNotHeardIsNotWaitedForButLeft) {
  Meeting m;
  m.other.heard = false, m.other.phase = TeamPhase::landing, m.other.robot = kMaxRobots;
  Action last = m.step();
  for (int i = 0; i < 50 && last != Action::leave; ++i) last = m.step();
  EXPECT_EQ(last, Action::leave);
  EXPECT_GT(m.other.position.x(), 4) << "at once, not when it is near";
}

// As it was: one in a niche left it when the other flew by, and crossed its path.
TEST(YieldState, WhoStandsAsideStaysWhileOneThatIsNotHeardFliesBy) {
  Meeting m;
  m.other.heard = false, m.other.phase = TeamPhase::landing, m.other.robot = kMaxRobots;
  ASSERT_EQ(m.run(5), Action::leave);
  m.yield_state.set_out();
  m.self.position = {0, 2, 0};
  m.yield_state.arrived(YieldState::Place::aside, m.now);
  m.other.position = {5, 0, 0};
  while (m.other.position.x() > 0) ASSERT_EQ(m.step(), Action::hold) << m.other.position.x();
  m.other.position = {5, 2, 0};
  Action last = m.step();
  for (int i = 0; i < 30 && last == Action::hold; ++i) last = m.step();
  EXPECT_EQ(last, Action::leave) << "this time it comes straight at it";
}

// As it was: each turned to leave, saw the other stand, and stayed.
TEST(YieldState, WhoLeavesOneThatIsNotHeardGoesToWhereItSetOutFor) {
  Meeting m;
  m.other.heard = false, m.other.phase = TeamPhase::landing, m.other.robot = kMaxRobots;
  ASSERT_EQ(m.run(5), Action::leave);
  m.yield_state.set_out();
  m.other.velocity_mps.setZero(), m.other.phase = TeamPhase::aside;
  EXPECT_EQ(m.run(10), Action::hold);
  m.yield_state.arrived(YieldState::Place::aside, m.now);
  EXPECT_EQ(m.run(10), Action::go_on);
}

TEST(YieldState, OfTwoThatSeeAndDoNotHearEachOtherStandTheLowerNumberGoesOnFirst) {
  const auto waits_s = [](RobotId self) {
    Meeting m;
    m.self.robot = self;
    m.other = {kMaxRobots, {2.5, 0, 0}, {-0.5, 0, 0}, TeamPhase::landing, 0, false};
    m.step();
    m.other.velocity_mps.setZero(), m.other.phase = TeamPhase::aside;
    const TimeNs stands = m.now;
    while (m.step() != Action::go_on && m.now < 60 * kSecond) {
    }
    return seconds(m.now - stands);
  };
  EXPECT_LT(waits_s(1), 2);
  EXPECT_GT(waits_s(2), waits_s(1) + 2);
  EXPECT_GT(waits_s(3), waits_s(2) + 2);
  EXPECT_LT(waits_s(3), 9);
}

TEST(YieldState, WithNoRoomGoesBeforeTheOther) {
  Meeting m;
  ASSERT_EQ(m.run(4), Action::make_room);
  m.yield_state.no_room(m.now, false);
  EXPECT_EQ(m.yield_state.reported(TeamPhase::explore, m.now), TeamPhase::boxed);
  // The other hears it, and gives way to it.
  Neighbour boxed = m.self;
  boxed.phase = TeamPhase::boxed;
  EXPECT_TRUE(goes_before(boxed, m.other));
  m.other.velocity_mps = {1, 0, 0};
  EXPECT_EQ(m.run(3), Action::go_on);
}

// As it was: it flew on, into the one behind it.
TEST(YieldState, OnItsWayToMakeRoomStopsForAThirdThatItFliesAt) {
  Meeting m;
  Neighbour third{3, {-8, 0, 0}};
  const auto step = [&] {
    m.now += kSecond / 10;
    m.self.position += 0.1 * m.self.velocity_mps;
    return m.yield_state.update({}, m.self, {m.other, third}, m.now, m.self.velocity_mps.isZero(), 0);
  };
  ASSERT_EQ(m.run(4), Action::make_room);
  m.yield_state.set_out();
  m.self.velocity_mps = {-1, 0, 0};
  Action last = step();
  while (last == Action::hold && m.self.position.x() > -8) last = step();
  EXPECT_EQ(last, Action::stop);
  const SeparationRule rule;
  EXPECT_NEAR(m.self.position.x(), -8 + rule.distance_m / 2 + rule.own_s + 0.5 / rule.brake_mps2, 0.11);
  m.self.velocity_mps.setZero(), m.other.velocity_mps.setZero();
  EXPECT_EQ(step(), Action::hold);
  for (int i = 0; i < 40 && last != Action::make_room; ++i) last = step();
  EXPECT_EQ(last, Action::make_room) << "for another place";
}

// As it was: without room it waited for one that did not hear it until that one had left.
TEST(YieldState, WithNoRoomGoesBeforeOneThatIsNotHeardAndDoesNotComeNearer) {
  Meeting m;
  m.other = {kMaxRobots, {3.2, 0, 0}, {-0.16, 0, 0}, TeamPhase::landing, 0, false};
  Action last = m.step();
  for (int i = 0; i < 40 && last != Action::leave && last != Action::make_room; ++i) {
    m.other.velocity_mps.y() = i % 2 ? 0.4 : -0.4;  // to and fro
    last = m.step();
  }
  ASSERT_EQ(last, Action::leave);
  m.other.velocity_mps = {0, 0.2, 0};
  m.yield_state.no_room(m.now, false);
  while (m.step() != Action::go_on) ASSERT_LT(m.now, 10 * kSecond);

  Meeting comes;
  comes.other = {kMaxRobots, {3.2, 0, 0}, {-0.16, 0, 0}, TeamPhase::landing, 0, false};
  while (comes.step() != Action::leave) ASSERT_LT(comes.now, 5 * kSecond);
  comes.yield_state.no_room(comes.now, false);
  EXPECT_EQ(comes.run(4), Action::leave) << "it does not know who goes first";
}

// As it was: one that stood left when the other, which took it for rock, was about to pass.
TEST(YieldState, WhoStandsDoesNotSetOutWhenOneThatIsNotHeardIsNear) {
  Meeting m;
  m.other = {kMaxRobots, {3, 0, 0}, {-1.7, 0, 0}, TeamPhase::landing, 0, false};
  while (m.other.position.x() > 0.5) ASSERT_EQ(m.step(), Action::hold) << m.other.position.x();
}

TEST(YieldState, AmongACrowdWaitsLongerForRoomBeforeItGoesFirst) {
  Meeting m;
  m.other.position = {2.9, 0, 0}, m.other.velocity_mps.setZero();
  ASSERT_EQ(m.run(10), Action::make_room);
  m.yield_state.no_room(m.now, true);
  EXPECT_EQ(m.yield_state.reported(TeamPhase::explore, m.now), TeamPhase::explore);
  ASSERT_EQ(m.run(10), Action::leave);
  m.yield_state.no_room(m.now, true);
  EXPECT_EQ(m.yield_state.reported(TeamPhase::explore, m.now), TeamPhase::boxed);
}

TEST(YieldState, WhoGoesFirstWaitsForTheOtherToStandAside) {
  Meeting m;
  std::swap(m.self.robot, m.other.robot);
  m.other.position = {1.9, 0, 0};
  ASSERT_EQ(m.step(), Action::hold) << "both stop that near";
  m.other.velocity_mps.setZero();
  EXPECT_EQ(m.run(3), Action::hold);
  m.other.phase = TeamPhase::aside;
  EXPECT_EQ(m.run(2), Action::go_on);
}

}  // namespace
}  // namespace karst::core
