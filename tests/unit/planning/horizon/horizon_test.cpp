#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <numbers>

#include "core_stack/planning/horizon/horizon_planner.h"
#include "core_stack/planning/search/grid_planner.h"
#include "tests/unit/planning/horizon/camera_vehicle.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

MotionLimits limits() {
  MotionLimits out;
  out.max_acceleration_mps2 = 1.5;
  return out;
}

/// A hall of 8 x 4 m, known up to x = `known_m`, and from x = 2 to 12 m only up to y = `known_y_m`.
VoxelMap hall(double known_m, std::vector<CellChange>& changes, double known_y_m = 8) {
  VoxelMap map{MapOptions{}};
  const int known = static_cast<int>(known_m / map.resolution_m());
  const int known_y = static_cast<int>(known_y_m / map.resolution_m());
  testing::draw(
      map, {-1, -1, -1}, {known, 41, 21},
      [&](const CellKey& k) {
        if (k.x >= 10 && k.x < 60 && k.y >= known_y) return Cell::unknown;
        const bool inside = k.x >= 0 && k.y >= 0 && k.y < 40 && k.z >= 0 && k.z < 20;
        return inside ? Cell::free : Cell::occupied;
      },
      &changes);
  return map;
}

TEST(ViewGain, OfNothingKnownIsTheIntegralOverTheView) {
  const VoxelMap map{MapOptions{}};
  const std::vector<ViewRay> rays = view_rays(camera_vehicle());
  ViewMap view(map, Vec3::Zero(), 2, rays);
  const double range_m = 0.9 * 4.5, lambda = ViewMap::kExpected_m;
  double solid_angle_sr = 0;
  for (const ViewRay& r : rays) solid_angle_sr += r.solid_angle_sr;
  EXPECT_NEAR(solid_angle_sr, 1.38 * 2 * std::sin(0.55), 0.01);
  const double x = range_m / lambda;  // of r^2 e^(-r / lambda) dr
  const double integral = lambda * lambda * lambda * (2 - std::exp(-x) * (x * x + 2 * x + 2));
  EXPECT_NEAR(view.gain_m3(std::array{ViewPose{}}), solid_angle_sr * integral,
              0.12 * solid_angle_sr * integral);
}

TEST(ViewGain, CountsEachCellOnceAndNothingBehindRock) {
  std::vector<CellChange> changes;
  VoxelMap map = hall(6, changes);
  const std::vector<ViewRay> rays = view_rays(camera_vehicle());
  ViewMap view(map, Vec3(4, 4, 2), 4, rays);
  const ViewPose ahead{{4, 4, 2}, 0}, back{{4, 4, 2}, std::numbers::pi};
  const double once = view.gain_m3(std::array{ahead});
  EXPECT_GT(once, 1);
  EXPECT_DOUBLE_EQ(view.gain_m3(std::array{ahead, ahead}), once);
  EXPECT_DOUBLE_EQ(view.gain_m3(std::array{back}), 0);
  for (int y = 0; y < 40; ++y)
    for (int z = 0; z < 20; ++z) map.assign({29, y, z}, 1, 2.0f);  // a wall before what is unknown
  ViewMap walled(map, Vec3(4, 4, 2), 4, rays);
  EXPECT_DOUBLE_EQ(walled.gain_m3(std::array{ahead}), 0);
}

TEST(ViewGain, OfLongRaysIsAboutThatOfShortOnesInTheSameRoom) {
  std::vector<CellChange> changes;
  const VoxelMap map = hall(6, changes);
  std::vector<ViewRay> rays = view_rays(camera_vehicle());
  for (ViewRay& r : rays) r.range_m = 5.9;  // the map's cells
  ViewMap fine(map, Vec3(4, 4, 2), 0, rays);
  const std::array ahead{ViewPose{{4, 4, 2}, 0}};
  const double fine_m3 = fine.gain_m3(ahead);
  for (ViewRay& r : rays) r.range_m = 6.1;  // cells of twice the size
  ViewMap coarse(map, Vec3(4, 4, 2), 0, rays);
  EXPECT_NEAR(coarse.gain_m3(ahead) / fine_m3, 1, 0.2);
}

TEST(Rollout, KeepsToTheLimitsAndEndsAtRest) {
  rc::check([] {
    const auto real = [](double low, double high) {
      return low + (high - low) * *rc::gen::inRange(0, 1000001) / 1e6;
    };
    const MotionLimits l = limits();
    const auto velocity = [&] {
      Vec3 v;
      for (int i = 0; i < 3; ++i) v[i] = real(-1, 1);
      return Vec3(v * (l.max_speed_mps / std::max(1.0, v.norm())));
    };
    MotionState start;
    start.velocity_mps = velocity();
    start.heading_rate_radps = real(-1, 1);
    for (int i = 0; i < 3; ++i) start.acceleration_mps2[i] = real(-0.8, 0.8);
    Legs legs;
    for (Leg& leg : legs) {
      leg.velocity_mps = velocity();
      leg.heading_rad = real(-3, 3);
    }
    const Rollout r = roll_out(start, legs, l, 1.2);
    const auto& s = r.samples;
    const double dt = 0.1;
    Vec3 before = start.velocity_mps;
    for (std::size_t i = 1; i < s.size(); ++i) {
      const Vec3 v = (s[i].position - s[i - 1].position) / dt;
      RC_ASSERT(v.norm() < l.max_speed_mps + 1e-6);
      RC_ASSERT((v - before).norm() < dt * l.max_acceleration_mps2 + 1e-6);
      RC_ASSERT(std::abs(wrap_angle(s[i].heading_rad - s[i - 1].heading_rad)) <
                dt * l.max_heading_rate_radps + 1e-9);
      before = v;
    }
    RC_ASSERT(before.norm() <= 0.5 * dt * 1.2 + 1e-6);  // the mean of the last step
  });
}

TEST(Rollout, ALegEndsWhereItIsToIfAccelerationSuffices) {
  MotionLimits l = limits();
  l.max_acceleration_mps2 = l.max_jerk_mps3 = 1e3;
  l.max_speed_mps = 10;
  MotionState s;
  s.velocity_mps = {1, -0.5, 0.2};
  const Vec3 to(1.5, 0.5, -0.3);
  const MotionState end = end_of_leg(s, {velocity_to(to, s), 0}, l);
  EXPECT_LT((end.position - to).norm(), 1e-9);
}

class HorizonTest : public ::testing::Test {
 protected:
  HorizonTest() : map(hall(16, changes)) {
    roadmap.update(map, changes);
    query.limits = limits();
    query.braking_mps2 = 1.2;
    query.start.position = {3, 4, 2};
    query.goal.position = {14, 4, 2};
  }
  std::optional<HorizonPlan> plan() {
    to_goal.update(roadmap, query.goal.position);
    return plan_horizon(map, roadmap, to_goal, rays, query);
  }

  std::vector<CellChange> changes;
  VoxelMap map;
  PlanningOptions options;
  Roadmap roadmap{options};
  DistanceTree to_goal;
  std::vector<ViewRay> rays = view_rays(camera_vehicle());
  HorizonQuery query;
};

TEST_F(HorizonTest, FliesToTheGoalAsFastAsItCanWhereNothingIsToBeSeen) {
  query.worth_s_per_m3 = 0;
  const auto p = plan();
  ASSERT_TRUE(p);
  const double direct_s = 11 / 2.0 + 2 / 1.5;
  EXPECT_LT(p->time_left_s, 1.15 * direct_s);
  EXPECT_GT(p->samples[30].position.x(), 7);
}

TEST_F(HorizonTest, EveryPlanIsClearToItsStopAndTheSameEachTime) {
  int plans = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    query.seed = seed;
    query.start.position.y() = 1 + 0.3 * static_cast<double>(seed);
    query.start.velocity_mps = {1.5, seed % 2 ? 0.5 : -0.5, 0};
    const auto p = plan();
    if (!p) continue;
    ++plans;
    std::vector<Vec3> points;
    for (const TrajectorySample& s : p->samples) points.push_back(s.position);
    EXPECT_EQ(first_blocked_segment(map, points, query.clearance_m - 0.02), -1) << seed;
    const auto again = plan();
    ASSERT_TRUE(again);
    ASSERT_EQ(again->samples.size(), p->samples.size());
    for (std::size_t i = 0; i < p->samples.size(); ++i)
      ASSERT_EQ(again->samples[i].position, p->samples[i].position);
  }
  EXPECT_GE(plans, 15);
}

// As it was: to be still on the way in three seconds was worth more than to be there.
TEST_F(HorizonTest, ArrivesAtTheGoalAndFacesAsAsked) {
  query.worth_s_per_m3 = 0;
  query.goal = {{6, 4, 2}, 1.0};
  for (int i = 0; i < 40; ++i) {
    query.seed = static_cast<std::uint64_t>(i);
    const auto p = plan();
    const std::vector<TrajectorySample> s = p ? p->samples : query.under_way;
    ASSERT_FALSE(s.empty());
    const auto at = [&](std::size_t k) { return s[std::min(k, s.size() - 1)]; };
    query.start = {at(3).position, (at(4).position - at(2).position) / 0.2,
                   (at(4).position - 2 * at(3).position + at(2).position) / 0.01, at(3).heading_rad,
                   wrap_angle(at(4).heading_rad - at(2).heading_rad) / 0.2};
    query.under_way.assign(s.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(3, s.size() - 1)),
                           s.end());
    if (p) query.last = p->legs;
  }
  EXPECT_LT((query.start.position - query.goal.position).norm(), 0.5);
  EXPECT_LT(std::abs(wrap_angle(query.start.heading_rad - 1.0)), 0.3);
}

TEST_F(HorizonTest, TurnsToWhatItHasNotSeenWhereThatIsWorthIt) {
  changes.clear();
  map = hall(16, changes, 6.4);
  roadmap = Roadmap{options};
  roadmap.update(map, changes);
  query.worth_s_per_m3 = 0;
  const auto fast = plan();
  query.worth_s_per_m3 = 0.5;
  const auto sees = plan();
  ASSERT_TRUE(fast && sees);
  ViewMap view(map, query.start.position, 8, rays);
  const auto gain_m3 = [&](const HorizonPlan& p) {
    const auto pose = [&](std::size_t i) {
      return ViewPose{p.samples[i].position, p.samples[i].heading_rad};
    };
    return view.gain_m3(std::array{pose(10), pose(20), pose(30)});
  };
  EXPECT_GT(gain_m3(*sees), 3 * gain_m3(*fast) + 2);
  EXPECT_GT(sees->time_left_s, fast->time_left_s - 0.3) << "it costs time";
}

// As it was: a vehicle with a LiDAR never faced as the goal asked, and its colour camera saw little.
TEST_F(HorizonTest, AVehicleThatNeedNotTurnOnTheWayFacesAsTheGoalAsks) {
  query.turns = false;
  query.start.heading_rad = 0.4;
  const auto keeps = plan();
  query.goal.heading_rad = -1.2;
  const auto faces = plan();
  ASSERT_TRUE(keeps && faces);
  EXPECT_NEAR(keeps->samples.back().heading_rad, 0.4, 1e-9);
  EXPECT_NEAR(faces->samples.back().heading_rad, -1.2, 0.05);
}

TEST_F(HorizonTest, WithoutAWayToTheGoalThereIsNoPlan) {
  query.goal.position = {30, 4, 2};
  EXPECT_FALSE(plan());
}

TEST_F(HorizonTest, WhatIsUnderWayIsKeptUnlessAPlanIsBetter) {
  query.worth_s_per_m3 = 0;
  const auto first = plan();
  ASSERT_TRUE(first);
  query.under_way = first->samples;
  const auto second = plan();
  if (second) {
    EXPECT_LT(second->time_left_s, first->time_left_s);
  }
}

}  // namespace
}  // namespace karst::core
