#include "core_stack/homing/landing/descent_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core_stack/mapping/region/flight_region.h"

namespace karst::core {
namespace {

using Floor = std::function<double(double x, double y)>;
constexpr double kRadius_m = 0.3;

/// A hall of 16 x 16 x 4 m, 2 m above the highest of its floor; what is nearer to the origin than `known_m`
/// is known.
VoxelMap hall(const Floor& floor_m, double known_m = 100) {
  VoxelMap map{MapOptions{}};
  for (int x = -40; x < 40; ++x)
    for (int y = -40; y < 40; ++y)
      for (int z = -40; z < 20; ++z) {
        const Vec3 c = map.center_of({x, y, z});
        if (c.norm() < known_m) map.assign({x, y, z}, 1, c.z() < floor_m(c.x(), c.y()) ? 2.0f : -2.0f);
      }
  return map;
}

/// The slope of the floor around, over the length of the vehicle.
double slope_deg(const Floor& floor_m, const Vec3& p) {
  const double h = kRadius_m;
  const double dx = (floor_m(p.x() + h, p.y()) - floor_m(p.x() - h, p.y())) / (2 * h);
  const double dy = (floor_m(p.x(), p.y() + h) - floor_m(p.x(), p.y() - h)) / (2 * h);
  return std::atan(std::hypot(dx, dy)) * 180 / M_PI;
}

TEST(DescentPath, LeadsStraightDownAboveFlatGround) {
  const VoxelMap map = hall([](double, double) { return -2.0; });
  EXPECT_EQ(descent_path(map, {{0.1, 0.1, 0.1}, {}, kRadius_m, {}}), (std::vector<Vec3>{{0.1, 0.1, 0.1}}));
}

TEST(DescentPath, LeadsToWhereItIsToLandIfThatIsNearAndInSight) {
  VoxelMap map = hall([](double, double) { return -2.0; });
  const Vec3 from(0.1, 0.1, 0.1), near(1.3, 0.9, 0.3), far(2.3, 0.1, 0.1);
  EXPECT_EQ(descent_path(map, {from, {}, kRadius_m, near}), (std::vector<Vec3>{from, near}));
  EXPECT_EQ(descent_path(map, {from, {}, kRadius_m, far}), (std::vector<Vec3>{from}));
  for (int y = -40; y < 40; ++y)
    for (int z = -40; z < 20; ++z) map.assign({4, y, z}, 1, 2.0f);
  EXPECT_EQ(descent_path(map, {from, {}, kRadius_m, near}).back().y(), 0.1) << "a wall is between";
}

TEST(DescentPath, LeadsToGroundWithinTheRegionOnly) {
  VoxelMap map = hall([](double, double) { return -2.0; });
  FlightRegion::Limits limits;
  limits.margin_m = 0.5;
  limits.keep_out = {box({-2, -2, -9}, {2, 2, -1})};  // below it
  map.confine(std::make_shared<const FlightRegion>(limits));
  const Vec3 from(0.1, 0.1, 0.1);
  const auto path = descent_path(map, {from, {}, kRadius_m, {}});
  ASSERT_EQ(path.size(), 2u);
  for (double z = from.z(); z > -2 + kRadius_m; z -= 0.05)
    EXPECT_GE(map.region()->depth_m({path.back().x(), path.back().y(), z}), kRadius_m);
  limits.keep_in = box({-20, -20, -1.8}, {20, 20, 9});  // above all ground
  map.confine(std::make_shared<const FlightRegion>(limits));
  EXPECT_TRUE(descent_path(map, {from, {}, kRadius_m, {}}).empty());
}

TEST(DescentPath, LeadsAsideFromASlopeThatThrowsAVehicleOver) {
  // 55 degrees for x < 2, and flat beyond.
  const Floor floor = [](double x, double) { return -3 + (x < 2 ? (x - 2) * -1.43 : 0.0) - 2.5; };
  const VoxelMap map = hall(floor);
  const auto path = descent_path(map, {{0.1, 0.1, 0.1}, {}, kRadius_m, {}});
  ASSERT_EQ(path.size(), 2u);
  EXPECT_EQ(path.front(), Vec3(0.1, 0.1, 0.1));
  EXPECT_LT(slope_deg(floor, path.back()), 16);
  EXPECT_LT((path.back() - path.front()).norm(), 4.01);
}

TEST(DescentPath, TakesASlopeItStandsOnWhereNothingFlatterIsNearButNoneThatThrowsItOver) {
  // In cells of 20 cm a slope looks a few degrees flatter or steeper than it is.
  for (const double slope : {24.0, 60.0}) {
    const double rise = std::tan(slope * M_PI / 180);
    const Floor floor = [rise](double x, double) { return -3.5 + rise * x; };
    const auto path = descent_path(hall(floor), {{0.1, 0.1, 0.1}, {}, kRadius_m, {}});
    EXPECT_EQ(path.empty(), slope > 50) << slope;
  }
}

TEST(DescentPath, FollowsTheWayFlownBackToGroundThatIsKnown) {
  const VoxelMap map = hall([](double x, double) { return x > 4.5 ? -1.0 : -90.0; });
  std::vector<Vec3> flown;
  for (int i = 1; i <= 7; ++i) flown.push_back(Vec3(0.1 + i, 0.1, 0.1));
  const auto path = descent_path(map, {{0.1, 0.1, 0.1}, flown, kRadius_m, {}});
  ASSERT_GE(path.size(), 5u);
  EXPECT_GT(path.back().x(), 4.9);
  for (std::size_t i = 1; i < path.size(); ++i) EXPECT_EQ(path[i], flown[i - 1]);
}

TEST(DescentPath, KnowsOfNoneInTheUnknownOrBehindAWall) {
  EXPECT_TRUE(descent_path(VoxelMap{MapOptions{}}, {{0, 0, 0}, {{1, 0, 0}}, kRadius_m, {}}).empty());
  EXPECT_TRUE(
      descent_path(hall([](double, double) { return -5.0; }, 2.5), {{0.1, 0.1, 0.1}, {}, kRadius_m, {}})
          .empty());
  // Flat ground on both sides of a wall at 1 m; below the vehicle a pit.
  VoxelMap map =
      hall([](double x, double y) { return x > 1.2 || x < -3 || std::abs(y) > 30 ? -1.0 : -90.0; });
  for (int y = -40; y < 40; ++y)
    for (int z = -40; z < 20; ++z) map.assign({5, y, z}, 1, 2.0f);
  const auto path = descent_path(map, {{0.1, 0.1, 0.1}, {}, kRadius_m, {}});
  ASSERT_EQ(path.size(), 2u);
  EXPECT_LT(path.back().x(), -3) << "not through the wall";
}

}  // namespace
}  // namespace karst::core
