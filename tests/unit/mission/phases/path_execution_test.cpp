#include "core_stack/mission/phases/path_execution.h"

#include "tests/unit/mission/onboard_fixture.h"

namespace karst::core {
namespace {

class PathExecutionTest : public OnboardTest {
 protected:
  /// At full speed, 30 m before the end.
  void under_way() {
    hover();
    fly_ahead(40);
    advance(6);
    phases.enter(Phase::takeoff, now());
    phases.enter(Phase::explore, now());
    ASSERT_GT(onboard.flight.reference().velocity_mps.norm(), 1.8);
  }
};

TEST_F(PathExecutionTest, APlaceClosedFarAheadIsFlownAroundAndOneNearByIsBrakedFor) {
  under_way();
  path.avoid(25, phases, now());
  EXPECT_TRUE(path.detour_due());
  EXPECT_FALSE(path.blocked());
  EXPECT_FALSE(path.brakes_since(0));
  EXPECT_EQ(told("replan"), 1u);
  path.avoid(24, phases, now());
  EXPECT_EQ(told("replan"), 1u) << "said once";
  path.avoid(1.5, phases, now());
  EXPECT_TRUE(path.blocked());
  EXPECT_FALSE(path.detour_due());
  advance(3);
  EXPECT_TRUE(onboard.flight.at_rest(now()));
}

// As it was: a path to a waiting place, flown on the way back, was checked for touch only.
TEST_F(PathExecutionTest, BackAsItCameNothingFarAheadStopsItUntilTheNextPath) {
  under_way();
  path.fly_as_come();
  path.avoid(25, phases, now());
  EXPECT_FALSE(path.detour_due());
  const Vec3 from = onboard.flight.reference().position, to = from + Vec3(40, 0, 0);
  Route next;
  next.points = {from, to};
  path.follow(next, now());
  path.avoid(25, phases, now());
  EXPECT_TRUE(path.detour_due());
}

TEST_F(PathExecutionTest, ABrakeOutdatesWhatWasPlannedBeforeIt) {
  under_way();
  const TimeNs begun = now();
  advance(0.1);
  EXPECT_FALSE(path.braked_since(begun));
  path.brake(now());
  EXPECT_TRUE(path.braked_since(begun));
  EXPECT_TRUE(path.braked_since(now())) << "planned at that very moment";
  advance(0.1);
  EXPECT_FALSE(path.braked_since(now()));
  path.obey(SafetyAction::brake);
  EXPECT_TRUE(path.braked_since(now())) << "held by the supervisor";
  path.obey(SafetyAction::slow);
  EXPECT_FALSE(path.outdated(now()));
  path.yield(true);
  EXPECT_TRUE(path.outdated(now()));
  EXPECT_FALSE(path.braked_since(now())) << "who yields may still make room";
}

TEST_F(PathExecutionTest, WhoStandsIsNotBraked) {
  hover();
  path.stop(now());
  EXPECT_FALSE(path.brakes_since(0));
}

TEST_F(PathExecutionTest, ARouteIsFollowedFromWhereItJoinsTheTrajectoryToItsEnd) {
  under_way();
  path.block();
  const RouteStart start = path.start_at_stop(now());
  Path detour;
  detour.status = PlanStatus::found;
  const Vec3 from = start.committed.points.back(), to = from + Vec3(3, 4, 0);
  detour.points = {from, to};
  VoxelMap map{MapOptions{}};
  path.follow(make_route(map, onboard.options, onboard.vehicle, start, detour, {}), now());
  EXPECT_FALSE(path.blocked());
  double fastest_mps = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 before = onboard.flight.reference().position;
    advance(0.01);
    fastest_mps = std::max(fastest_mps, (onboard.flight.reference().position - before).norm() / 0.01);
  }
  EXPECT_LT((onboard.flight.reference().position - to).norm(), 0.05);
  EXPECT_LT(fastest_mps, 1.1 * onboard.options.motion.max_speed_mps);
  EXPECT_EQ(told("\"plan\""), 1u);
}

TEST_F(PathExecutionTest, OfATakeOffOnlyWhatIsAboveTheGroundHasToBeClear) {
  onboard.flight.climb(now(), 2, 0.5);
  EXPECT_LT(path.ahead(now(), std::nullopt).front().z(), 0.1);
  const auto above = path.ahead(now(), 0.8);
  ASSERT_FALSE(above.empty());
  for (const Vec3& p : above) EXPECT_GE(p.z(), 0.8);
  EXPECT_NEAR(above.back().z(), 2, 1e-6);
}

}  // namespace
}  // namespace karst::core
