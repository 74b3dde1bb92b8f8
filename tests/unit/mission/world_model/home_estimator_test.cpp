#include "core_stack/mission/world_model/home_estimator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core_stack/homing/path_home/home.h"
#include "tests/unit/homing/passage.h"
#include "tests/unit/mission/mapped_world.h"

namespace karst::core {
namespace {

struct Estimating {
  CoreOptions options;
  VehicleDescription vehicle = lidar_vehicle_at_start();
  WorldModel world;
  TeamMembership team;
  HomeEstimator home;

  explicit Estimating(const VoxelMap& map, const CoreOptions& o = {})
      : options(o), world(o, vehicle), home(o, vehicle, world, team) {
    world.integrate(rays_of(map));
  }
  /// Rest to rest along `length_m` with the options' limits, and down from 1.7 m to 1 m at 0.4 m/s.
  double time_home_s(double length_m) const {
    return flight_time_s(length_m, options.motion) + options.mission.takeoff_height_m / 0.4;
  }
};

TEST(HomeEstimator, MeasuresThePathThroughTheMap) {
  Estimating e(room_open_to_x());
  const Vec3 from(7, 5, 2.5);
  const HomeEstimate home = e.home.estimate(from, 1000);
  const double straight_m = (from - e.world.home()).norm();
  EXPECT_GE(home.length_m, straight_m - 1e-9);
  EXPECT_LE(home.length_m, 1.3 * straight_m);
  EXPECT_NEAR(home.time_s, e.time_home_s(home.length_m), 1e-9);
  EXPECT_FALSE(e.team.homing()) << "alone there is no other place to land";
}

TEST(HomeEstimator, CountsTheFlownPathWhereTheMapKnowsNone) {
  Estimating e(room_open_to_x());
  const HomeEstimate home = e.home.estimate(Vec3(100, 5, 2.5), 160);
  EXPECT_EQ(home.length_m, 160);
  EXPECT_NEAR(home.time_s, e.time_home_s(160), 1e-9);
}

TEST(HomeEstimator, NarrowPassagesTakeLonger) {
  Estimating e(rooms_with_a_narrow_corridor(), narrow_passages_allowed());
  const Vec3 beyond(12, 3, 1.4);
  EXPECT_EQ(e.home.estimate(beyond, 160).length_m, 160) << "narrow passages are not in use yet";
  e.world.narrow();
  const HomeEstimate home = e.home.estimate(beyond, 160);
  EXPECT_NEAR(home.length_m, 9, 1);
  // Some 2.6 m of it are narrow (WorldModel.MeasuresTheNarrowPartOfAPath).
  const double slow_mps = e.options.safety.slow_fraction * e.options.motion.max_speed_mps;
  EXPECT_NEAR(home.time_s - e.time_home_s(home.length_m), 2.6 / slow_mps, 1 / slow_mps);
}

TEST(HomeEstimator, SlackIsWhatTheMarginAndTheReserveLeave) {
  CoreOptions options;
  options.mission.home_margin = 0.5;
  options.mission.home_reserve_s = 7;
  Estimating e(room_open_to_x(), options);
  EXPECT_NEAR(e.home.slack_s(100, {50, 40}), 100 - 1.5 * 40 - 7, 1e-9);
}

TEST(HomeEstimator, ATeammatesTimeIsWorkedOutAsOnesOwn) {
  Estimating e(room_open_to_x());
  const Vec3 there(6, 4, 2);
  TeammateState teammate{2, 40 * kSecond, there, {0.5, 0, 0}, Vec3(6.5, 3, 2), true, 300};
  const OtherVehicle seen = e.home.seen_by_policy(teammate, 50 * kSecond);
  EXPECT_EQ(seen.id, 2u);
  EXPECT_EQ(seen.heard, teammate.heard);
  EXPECT_EQ(seen.position, there);
  EXPECT_EQ(seen.velocity_mps, teammate.velocity_mps);
  EXPECT_EQ(seen.goal, teammate.goal);
  EXPECT_NEAR(seen.seconds_before_homing, e.home.slack_s(290, e.home.estimate(there, 0)), 1e-9)
      << "ten seconds have passed";
  teammate.position.x() = 90;
  EXPECT_TRUE(std::isnan(e.home.seen_by_policy(teammate, 0).seconds_before_homing)) << "where this map ends";
  teammate.explores = false;
  EXPECT_EQ(e.home.seen_by_policy(teammate, 0).seconds_before_homing, 0);
}

TEST(HomeEstimator, InATeamALandingSpotCountsIfItTakesLessTime) {
  // 53 m along a passage; the base's antenna is where the passage begins.
  const Vec3 base(-28, 0.1, 1), far(25, 0.1, 1);
  CoreOptions options;
  options.homing.landing.link.spare_db = 6;
  Estimating e(testing::passage(4, 3.2, 60), options);
  e.world.set_home(base);
  RelayHoming homing(1, {options.team, options.homing, options.planning, options.motion, 0.3, base});
  TeamNews news;
  news.relays = {{kBase, base, base}};
  news.ends = 600 * kSecond;
  const HomeEstimate alone = e.home.estimate(far, 0);
  for (double x = -27; x <= 25; x += 1)
    homing.update(e.world.map(), e.world.usual().roadmap(), {x, 0.1, 1}, news, {});
  EXPECT_EQ(e.home.estimate(far, 0).length_m, alone.length_m) << "it has not joined";
  e.team.join(&homing, 4);
  const auto spot = homing.spot_from(e.world.map(), e.world.usual().roadmap(), far, 1e9);
  ASSERT_TRUE(spot);
  ASSERT_LT(spot->time_s, alone.time_s);
  EXPECT_EQ(e.home.estimate(far, 0).length_m, spot->length_m);
  EXPECT_EQ(e.home.estimate(far, 0).time_s, spot->time_s);
  const auto landing = e.home.landing_spot(far, 0);
  ASSERT_TRUE(landing);
  EXPECT_LE(landing->time_s, spot->time_s) << "the ground here was judged too";
  const Vec3 near(-27, 0.1, 1);
  EXPECT_NEAR(e.home.estimate(near, 0).length_m, 1, 0.5) << "home is nearer than any spot";
  EXPECT_FALSE(e.home.landing_spot(near, 0));
}

}  // namespace
}  // namespace karst::core
