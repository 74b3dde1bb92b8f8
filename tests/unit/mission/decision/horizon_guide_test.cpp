#include "core_stack/mission/decision/horizon_guide.h"

#include <gtest/gtest.h>

#include "core_stack/planning/search/grid_planner.h"
#include "tests/unit/mission/mapped_world.h"
#include "tests/unit/planning/horizon/camera_vehicle.h"

namespace karst::core {
namespace {

class HorizonGuideTest : public ::testing::Test {
 protected:
  HorizonGuideTest() {
    query.start.position = Vec3(2, 3, 2);
    query.start.velocity_mps = Vec3(1, 0, 0);
    query.goal.position = Vec3(6, 3, 2);
    query.limits.max_acceleration_mps2 = 1.5;
    query.braking_mps2 = 1.2;
  }
  std::optional<HorizonPlan> plan(const VoxelMap& map, std::optional<double> exploring_s = 60) {
    world.integrate(rays_of(map));
    return guide.plan(world, query, exploring_s);
  }
  double least_clearance_m(const HorizonPlan& p) const {
    double least = 9;
    for (const TrajectorySample& s : p.samples) {
      double clear = 0;
      while (clear < 2 && segment_clear(world.map(), s.position, s.position, clear + 0.02)) clear += 0.02;
      least = std::min(least, clear);
    }
    return least;
  }

  VehicleDescription vehicle = camera_vehicle();
  WorldModel world{CoreOptions{}, vehicle};
  HorizonGuide guide{vehicle};
  HorizonQuery query;
};

TEST_F(HorizonGuideTest, PlansTowardsTheGoal) {
  const auto p = plan(room_open_to_x(), std::nullopt);
  ASSERT_TRUE(p);
  EXPECT_GT(p->samples.back().position.x(), 4);
  EXPECT_LT(p->time_left_s, 5);
}

TEST_F(HorizonGuideTest, WithoutAClearWayToTheGoalThereIsNoPlan) {
  query.goal.position = Vec3(20, 3, 2);
  EXPECT_FALSE(plan(room_open_to_x()));
}

// As it was: plans kept 0.1 m more than paths, so in such a passage there were none, and the vehicle stopped.
TEST_F(HorizonGuideTest, PlansWhereAPathJustFits) {
  const double clearance_m = world.usual().clearance_m();
  VoxelMap passage{MapOptions{}};
  const double wide_m = 2 * clearance_m + 0.4;  // and a cell of rock on both sides
  carve_box(passage, Vec3(0, 3 - wide_m / 2, 0), Vec3(12, 3 + wide_m / 2, 4));
  query.goal.position = Vec3(10, 3, 2);
  const auto p = plan(passage);
  ASSERT_TRUE(p);
  EXPECT_GT(p->samples.back().position.x(), 4);
  EXPECT_GT(least_clearance_m(*p), clearance_m - 0.05);
}

TEST_F(HorizonGuideTest, AFlightThatExploresLooksAtWhatItHasNotSeen) {
  VoxelMap map{MapOptions{}};
  carve_box(map, Vec3(0, 0, 0), Vec3(16, 6, 4), {"y+"});
  query.goal.position = Vec3(14, 3, 2);
  const auto explores = plan(map, 120), transits = plan(map, std::nullopt);
  ASSERT_TRUE(explores && transits);
  const auto most_left_rad = [](const HorizonPlan& p) {
    double most = 0;
    for (const TrajectorySample& s : p.samples) most = std::max(most, s.heading_rad);
    return most;
  };
  EXPECT_GT(most_left_rad(*explores), 0.7);
  EXPECT_LT(most_left_rad(*transits), 0.5);
}

}  // namespace
}  // namespace karst::core
