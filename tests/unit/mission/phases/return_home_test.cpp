#include "core_stack/mission/phases/return_home.h"

#include <algorithm>
#include <cmath>

#include "tests/unit/mission/drawn_map.h"
#include "tests/unit/mission/onboard_fixture.h"

namespace karst::core {
namespace {

class ReturnHomeTest : public OnboardTest {
 protected:
  using OnboardTest::OnboardTest;
  static VehicleDescription with_camera() {
    VehicleDescription v = with_lidar();
    v.lidar.reset();
    v.cameras = {std::make_shared<CameraModel>()};
    return v;
  }
  void explore_and_go_home(double away_m) {
    hover();
    home.set_home(onboard.flight.reference().position);
    phases.enter(Phase::takeoff, now());
    phases.enter(Phase::explore, now());
    fly_ahead(away_m);
    const double fly_s = away_m + 4;
    for (double t = 0; t < fly_s; t += 0.1) {
      advance(0.1);
      flown_path.note(onboard.flight.reference().position);
    }
    home.begin("enough");
  }
  /// Steps ten times a second; stops when `until` holds.
  double steps(double at_most_s, const std::function<bool()>& until) {
    double t = 0;
    for (; t < at_most_s && !until(); t += 0.1) {
      home.step();
      advance(0.1);
    }
    return t;
  }

  bool company = false;
  std::string landed_here, landed = "no";
  ReturnHome home{onboard,
                  {phases, goals, path, flown_path, endurance, nullptr},
                  {.enter =
                       [this](Phase to, const std::string& reason) {
                         phases.enter(to, now());
                         if (to == Phase::land) landed = reason;
                       },
                   .land_here =
                       [this](const std::string& reason) {
                         phases.enter(Phase::land, now());
                         landed_here = reason;
                       },
                   .in_company = [this] { return company; },
                   .give_up_goals = [] {}}};
};

TEST_F(ReturnHomeTest, WithoutAWayThroughTheMapItFliesBackAsItCameAndLandsAtHome) {
  explore_and_go_home(6);
  EXPECT_EQ(home.reason(), "enough");
  steps(60, [this] { return phases.in(Phase::land); });
  EXPECT_EQ(landed, "");
  EXPECT_EQ(landed_here, "");
  EXPECT_LT((onboard.flight.reference().position - home.hover()).norm(), 0.4);
  EXPECT_GE(told("no path home"), 3u);
  EXPECT_EQ(told("back the way it came"), 1u);
}

/// A ring of corridors; the side between the vehicle and home has come to look too tight for the usual
/// clearance since the vehicle flew through it, or closed.
class TightWayHomeTest : public ReturnHomeTest {
 protected:
  using ReturnHomeTest::ReturnHomeTest;
  void fly_home_from_the_far_end(double battery_s) {
    Explorer& explorer = onboard.map.while_idle();
    const auto carve = [&](const Vec3& low, const Vec3& high, const std::vector<std::string>& open) {
      explorer.integrate(box_rays(explorer.map(), low, high, open));
    };
    carve({-2, -2, -1}, {5, 2, 3}, {"x+", "y+"});
    carve({5, -0.5, -1}, {7, 0.5, 3},
          closed ? std::vector<std::string>{"x-"} : std::vector<std::string>{"x-", "x+"});
    carve({7, -2, -1}, {14, 2, 3}, {"x-", "y+"});
    carve({-2, 2, -1}, {2, 14, 3}, {"y-", "x+"});
    carve({10, 2, -1}, {14, 14, 3}, {"y-", "x-"});
    carve({2, 10, -1}, {10, 14, 3}, {"x-", "x+"});
    endurance.note({.seconds_left = battery_s});
    explore_and_go_home(12);
    steps(90, [this] {
      const Vec3 here = onboard.flight.reference().position;
      flown_path.note(here);
      greatest_y_m = std::max(greatest_y_m, here.y());
      if (meanwhile) meanwhile(here);
      return phases.in(Phase::land);
    });
  }
  void expect_at_home() {
    EXPECT_EQ(landed, "");
    EXPECT_LT((onboard.flight.reference().position - home.hover()).norm(), 0.4);
  }
  std::size_t times_as_come() {
    return told("does not last for the path through the map: back the way it came");
  }

  bool closed = false;
  double greatest_y_m = 0;
  std::function<void(const Vec3& here)> meanwhile;
};

// As it was: a passage closed in the map on the way home, and the battery ended on the long way round.
TEST_F(TightWayHomeTest, WhereTheBatteryDoesNotLastForTheLongWayRoundItFliesBackAsItCame) {
  fly_home_from_the_far_end(20);
  EXPECT_EQ(times_as_come(), 1u);
  EXPECT_LT(greatest_y_m, 1);
  expect_at_home();
}

TEST_F(TightWayHomeTest, WhereTheBatteryLastsItFliesTheLongWayRound) {
  fly_home_from_the_far_end(60);
  EXPECT_EQ(told("back the way it came"), 0u);
  EXPECT_GT(greatest_y_m, 10);
  expect_at_home();
}

TEST_F(TightWayHomeTest, WithAnotherVehicleNearItFliesTheLongWayRound) {
  company = true;
  fly_home_from_the_far_end(20);
  EXPECT_EQ(times_as_come(), 0u);
  EXPECT_GT(greatest_y_m, 10);
}

// As it was: it turned round at each detour of the long way, back to where the flown path was closed.
TEST_F(TightWayHomeTest, StoppedOnTheWayBackAsItCameItKeepsToTheLongWayRound) {
  double next_y_m = 3;
  meanwhile = [&](const Vec3& here) {
    if (path.as_come() && here.x() < 7.6 && !path.blocked() && !onboard.flight.at_rest(now()))
      path.avoid(0.1, phases, now());
    if (path.as_come() || here.y() < next_y_m) return;
    next_y_m += 2;
    path.avoid(6, phases, now());
  };
  fly_home_from_the_far_end(20);
  EXPECT_EQ(times_as_come(), 1u);
  EXPECT_GT(greatest_y_m, 10);
  expect_at_home();
}

TEST_F(TightWayHomeTest, ItDoesNotFlyBackAsItCameWhereTheMapShowsThatItWouldTouch) {
  closed = true;
  fly_home_from_the_far_end(20);
  EXPECT_EQ(times_as_come(), 0u);
  EXPECT_GT(greatest_y_m, 10);
  expect_at_home();
}

class CameraTightWayHomeTest : public TightWayHomeTest {
 protected:
  CameraTightWayHomeTest() : TightWayHomeTest(with_camera()) {}
};

TEST_F(CameraTightWayHomeTest, ACameraVehicleFliesBackAsItCameToo) {
  fly_home_from_the_far_end(20);
  EXPECT_EQ(times_as_come(), 1u);
  EXPECT_LT(greatest_y_m, 1);
  expect_at_home();
}

class CameraReturnHomeTest : public ReturnHomeTest {
 protected:
  CameraReturnHomeTest() : ReturnHomeTest(with_camera()) {}
};

TEST_F(CameraReturnHomeTest, WithoutAWayThroughTheMapItFliesBackAsItCameAndLandsAtHome) {
  explore_and_go_home(6);
  steps(60, [this] { return phases.in(Phase::land); });
  EXPECT_EQ(landed, "");
  EXPECT_EQ(told("back the way it came"), 1u);
}

// As it was: where another had hovered before it and left, it kept for a minute to what its camera had seen.
TEST_F(CameraReturnHomeTest, BlockedOnTheWayBackItLooksAroundAndSetsOutAgain) {
  explore_and_go_home(6);
  steps(60, [this] { return told("back the way it came") > 0; });
  path.avoid(0.1, phases, now());
  double turned_rad = 0, last_rad = onboard.flight.reference().heading_rad;
  steps(60, [&] {
    const double heading_rad = onboard.flight.reference().heading_rad;
    turned_rad += std::abs(wrap_angle(heading_rad - last_rad));
    last_rad = heading_rad;
    return told("back the way it came") > 1;
  });
  EXPECT_GT(turned_rad, M_PI);
  steps(60, [this] { return phases.in(Phase::land); });
  EXPECT_EQ(landed, "") << "its patience does not run out";
  EXPECT_EQ(landed_here, "");
}

TEST_F(ReturnHomeTest, HeldInPlaceItsPatienceDoesNotRunOut) {
  explore_and_go_home(6);
  path.obey(SafetyAction::brake);
  steps(40, [this] { return phases.in(Phase::land); });
  EXPECT_TRUE(phases.in(Phase::home));
}

TEST_F(ReturnHomeTest, ThatGetsNowhereLandsWhereItIsAndLaterWithOthersNear) {
  for (const bool others : {false, true}) {
    if (others) phases = PhaseMachine{};
    company = others;
    landed_here = "";
    if (!others) explore_and_go_home(6);
    if (others) {
      phases.enter(Phase::takeoff, now());
      phases.enter(Phase::explore, now());
      home.begin("again");
    }
    // It is told to fly, and does not get away: the reference is put back each time.
    const double t = steps(100, [this] {
      path.block();
      onboard.flight.brake(now());
      return phases.in(Phase::land);
    });
    EXPECT_NE(landed_here, "");
    EXPECT_GT(t, others ? 59 : 11);
    EXPECT_LT(t, others ? 75 : 25);
  }
}

TEST_F(ReturnHomeTest, TurnsBackWhenTheTimeLeftOnlyJustSufficesAndNotBefore) {
  hover();
  home.set_home(onboard.flight.reference().position);
  phases.enter(Phase::takeoff, now());
  phases.enter(Phase::explore, now());
  const double min_s = onboard.options.mission.home_reserve_s;
  for (double left_s = 60; left_s > min_s + 12; left_s -= 1) {
    endurance.note({.seconds_left = left_s});
    advance(1 - seconds(now() % kSecond));
    home.watch_time();
    advance(0.2);
    ASSERT_TRUE(phases.in(Phase::explore)) << left_s;
  }
  for (double left_s = min_s + 12; phases.in(Phase::explore) && left_s > 0; left_s -= 1) {
    endurance.note({.seconds_left = left_s});
    advance(1 - seconds(now() % kSecond));
    home.watch_time();
    advance(0.2);
  }
  EXPECT_TRUE(phases.in(Phase::home));
  EXPECT_GT(endurance.seconds_left(now()), min_s - 3);
  EXPECT_EQ(told("\"battery\""), 1u);
}

}  // namespace
}  // namespace karst::core
