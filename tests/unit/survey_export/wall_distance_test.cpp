#include "sdk/survey_export/wall_distance.h"

#include <gtest/gtest.h>

#include "tests/unit/survey_export/carved_map.h"

namespace karst::survey_export {
namespace {

using core::Vec3;

TEST(WallDistance, IsThatOfTheWallToHalfACell) {
  const core::VoxelMap map = test::tunnel_map();
  const Vec3 p(15.1, 0.1, 1.5);
  EXPECT_NEAR(wall_distance_m(map, p, Vec3::UnitY()).value(), 2 - 0.1 + 0.1, 1e-6);
  EXPECT_NEAR(wall_distance_m(map, p, -Vec3::UnitX()).value(), 15.1 + 0.1, 1e-6);
  const Vec3 aslant = Vec3(0, 1, 1).normalized();  // reaches the roof 1.5 m above, through whole cells
  EXPECT_NEAR(wall_distance_m(map, p, aslant).value(), 1.5 * std::sqrt(2.0), 0.3);
}

TEST(WallDistance, ARayThatLeavesIntoUnknownSpaceGivesNoValue) {
  const core::VoxelMap map = test::tunnel_map(test::box({-10, -10, -10}, {50, 10, 0}));  // no floor was seen
  const survey::Dimensions d = dimensions_at(map, {15.1, 0.1, 1.5}, Vec3::UnitX());
  EXPECT_TRUE(d.left_m && d.right_m && d.up_m);
  EXPECT_FALSE(d.down_m);
}

TEST(WallDistance, ALoneUnknownCellIsPassed) {
  const core::VoxelMap map = test::tunnel_map(test::box({15, 1, 1.4}, {15.2, 1.2, 1.6}));
  EXPECT_NEAR(wall_distance_m(map, {15.1, 0.1, 1.5}, Vec3::UnitY()).value(), 2.0, 1e-6);
}

TEST(WallDistance, LeftIsAQuarterTurnCounterClockwiseOfTheFacing) {
  const core::VoxelMap map = test::tunnel_map();
  const survey::Dimensions d = dimensions_at(map, {15.1, 1.1, 0.5}, Vec3::UnitX());
  EXPECT_NEAR(*d.left_m, 0.9, 0.2);
  EXPECT_NEAR(*d.right_m, 3.1, 0.2);
  EXPECT_NEAR(*d.up_m, 2.5, 0.2);
  EXPECT_NEAR(*d.down_m, 0.5, 0.2);
}

/// Two legs that meet in the middle of the tunnel: one along it, one into the branch.
survey::Survey tee_legs() {
  survey::Survey s;
  for (const Vec3& p : {Vec3(5.1, 0.1, 1.5), Vec3(14.9, 0.1, 1.5), Vec3(14.9, 9.1, 1.5)}) {
    s.stations.emplace_back();
    s.stations.back().position_m = p;
  }
  s.legs.resize(2);
  s.legs[0].to = s.legs[1].from = 1;
  s.legs[1].to = 2;
  return s;
}

TEST(WallDistance, ARayIntoTheBranchRunsAlongItsLegAndOneToTheWallOppositeDoesNot) {
  const core::VoxelMap map = test::tee_map();
  const survey::Survey legs = tee_legs();
  for (const double x :
       {14.9, 13.9}) {  // the junction, and a place beside it that looks into the branch, too
    const Vec3 p(x, 0.1, 1.5);
    const survey::Dimensions d = dimensions_at(map, p, Vec3::UnitX());
    EXPECT_GT(d.left_m.value(), 14);
    const survey::Dimensions across = across_passage(map, legs, p, Vec3::UnitX(), d);
    EXPECT_FALSE(across.left_m) << x;
    EXPECT_EQ(across.right_m, d.right_m);
    EXPECT_TRUE(across.up_m && across.down_m);
  }
  EXPECT_FALSE(runs_along_leg(map, legs, {10.1, 0.1, 1.5}, Vec3::UnitY(), 2)) << "beyond the branch's mouth";
}

TEST(WallDistance, ALegBehindRockIsNotThatOfTheRay) {
  const core::VoxelMap map = test::tunnel_map();
  survey::Survey legs = tee_legs();
  EXPECT_TRUE(runs_along_leg(map, legs, {14.9, 0.1, 1.5}, Vec3::UnitY(), 2));
  legs.stations[1].position_m = {14.9, 2.1, 1.5};  // the second leg is in the rock
  EXPECT_FALSE(runs_along_leg(map, legs, {14.9, 0.1, 1.5}, Vec3::UnitY(), 2));
}

}  // namespace
}  // namespace karst::survey_export
