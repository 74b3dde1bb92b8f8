#include "core_stack/mission/world_model/clearance_checks.h"

#include <gtest/gtest.h>

#include "core_stack/common/random.h"
#include "core_stack/mapping/region/flight_region.h"
#include "tests/unit/mission/mapped_world.h"

namespace karst::core {
namespace {

constexpr ClearanceLimits kLimits{
    .usual_m = 0.6, .narrow_passages = true, .hull_radius_m = 0.3, .ground_z_m = 1};

/// From `p` to the centre of the nearest cell that is not free, less half a cell and the radius.
double hull_clearance_by_brute_force(const VoxelMap& map, const Vec3& p) {
  double nearest_m = 1e9;
  const CellKey at = map.key_of(p);
  for (int x = -6; x <= 6; ++x)
    for (int y = -6; y <= 6; ++y)
      for (int z = -6; z <= 6; ++z)
        if (const CellKey k = at + CellKey{x, y, z}; map.at(k) != Cell::free)
          nearest_m = std::min(nearest_m, (map.center_of(k) - p).norm());
  return nearest_m - map.resolution_m() / 2 - kLimits.hull_radius_m;
}

TEST(HullClearance, IsTheDistanceToTheNearestCellThatIsNotFree) {
  const VoxelMap map = room_open_to_x();
  Random random(3);
  int near = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p(0.3 + 7.4 * random.uniform(), 0.3 + 5.4 * random.uniform(), 0.3 + 3.4 * random.uniform());
    const double oracle_m = hull_clearance_by_brute_force(map, p);
    const std::optional<double> clearance_m = hull_clearance_m(map, kLimits, p);
    ASSERT_EQ(clearance_m.has_value(), oracle_m < 0.3) << p.transpose();  // what is farther does not matter
    if (!clearance_m) continue;
    ++near;
    EXPECT_NEAR(*clearance_m, oracle_m, 1e-5) << p.transpose();
  }
  EXPECT_GT(near, 50);
}

/// Along the wall y = 0, whose cells' centres lie at y = 0.1.
std::vector<Vec3> along_the_wall(double y) {
  return {Vec3(4, 3, 2), Vec3(2, 3, 2), Vec3(2, y, 2), Vec3(6, y, 2)};
}

TEST(BlockedSegment, IsTheFirstThatIsNearerToRockThanAllowed) {
  const VoxelMap map = room_open_to_x();
  // The usual clearance less 0.12 m is 0.48 m: y = 0.58.
  EXPECT_EQ(blocked_segment(map, kLimits, along_the_wall(0.65), {}), -1);
  EXPECT_EQ(blocked_segment(map, kLimits, along_the_wall(0.5), {}), 1) << "it leads to the wall";
  EXPECT_EQ(blocked_segment(map, kLimits, {Vec3(2, 0.5, 2), Vec3(6, 0.5, 2)}, {}), 0);
}

TEST(BlockedSegment, NeedsTheHullsRadiusOnlyNearNarrowPlaces) {
  const VoxelMap map = room_open_to_x();
  std::vector<Vec3> narrow;
  for (double x = 2; x <= 6; x += 0.5) narrow.push_back(Vec3(x, 0.5, 2));
  EXPECT_EQ(blocked_segment(map, kLimits, along_the_wall(0.5), narrow), -1);
  EXPECT_EQ(blocked_segment(map, kLimits, along_the_wall(0.35), narrow), 1) << "the hull would touch";
  ClearanceLimits usual_only = kLimits;
  usual_only.narrow_passages = false;
  EXPECT_EQ(blocked_segment(map, usual_only, along_the_wall(0.5), narrow), 1);
}

TEST(TouchingSegment, IsTheFirstNearerThanTheHullsRadius) {
  const VoxelMap map = room_open_to_x();
  EXPECT_EQ(touching_segment(map, kLimits, along_the_wall(0.5)), -1);
  EXPECT_EQ(touching_segment(map, kLimits, along_the_wall(0.35)), 1);
}

/// Outside, with unknown cells between it and the inside: only the flown path leads back.
TEST(TouchingSegment, TheFlownPathBackFromOutsideTheRegionIsNotBlockedByItsBorder) {
  VoxelMap map = room_open_to_x();
  for (int y = 0; y < 12; ++y)  // unknown, between y = 0 and 2.4
    for (int z = 0; z < 20; ++z) map.assign({20, y, z}, 0, 0.0f);
  FlightRegion::Limits limits;
  limits.keep_in = box({-1, -1, -1}, {4, 7, 5});
  limits.margin_m = 0.3;
  map.confine(std::make_shared<const FlightRegion>(limits));
  const std::vector<Vec3> flown_back{Vec3(6, 4.5, 2), Vec3(4, 4.5, 2), Vec3(2, 3, 2)};
  EXPECT_EQ(blocked_segment(map, kLimits, flown_back, {}), 0) << "no usual path leads out there";
  EXPECT_EQ(touching_segment(map, kLimits, flown_back), -1);
  EXPECT_EQ(touching_segment(map, kLimits, {Vec3(6, 0.35, 2), Vec3(6, 0.1, 2)}), 0) << "rock outside is rock";
}

TEST(HoverBelow, ALowRoofIsWhereThereIsRoomAboveAndBelow) {
  // The vehicle stands at z = 1, its hull of 0.3 m touches the ground. A roof's cells begin at their lower
  // face.
  const auto hover_m = [](double height_m, double highest_m) {
    VoxelMap map{MapOptions{}};
    carve_box(map, Vec3(0, 0, 0), Vec3(8, 6, height_m));
    return hover_below(map, kLimits, Vec3(3, 3, highest_m)).z();
  };
  EXPECT_EQ(hover_m(4, 2), 2) << "room enough";
  EXPECT_NEAR(hover_m(2.6, 2), 1.8, 0.06) << "0.6 m to the middle of the roof's cells, half a cell beyond";
  EXPECT_NEAR(hover_m(1.8, 1.3), 1.15, 0.06) << "in the middle, for want of that";
}

TEST(FlownBack, LeavesOutLoopsAndCutsNoCorner) {
  // A U around a wall: its ends are a metre apart, with rock between.
  VoxelMap map = room_open_to_x();
  std::vector<Vec3> flown;
  for (double x = 1; x < 6; x += 0.25) flown.push_back({x, 1.4, 2});
  for (double y = 1.4; y < 2.4; y += 0.25) flown.push_back({6, y, 2});
  for (double x = 6; x > 1; x -= 0.25) flown.push_back({x, 2.4, 2});
  EXPECT_LT(path_length_m(flown_back(map, kLimits, flown)), 2.1) << "straight over";
  std::vector<Ray> wall;
  for (double x = 0.5; x < 5; x += 0.1)
    for (double z = 0.5; z < 3.5; z += 0.1)
      for (int i = 0; i < 3; ++i) {
        const Vec3f origin(static_cast<float>(x), 1.2f, static_cast<float>(z));
        wall.push_back({origin, origin + Vec3f(0, 0.7f, 0), true});
      }
  map.insert(wall);
  const std::vector<Vec3> back = flown_back(map, kLimits, flown);
  EXPECT_TRUE(back.front() == flown.back() && back.back() == flown.front());
  EXPECT_GT(path_length_m(back), 7);
  for (std::size_t i = 1; i < back.size(); ++i)
    EXPECT_TRUE((back[i] - back[i - 1]).norm() < 0.26 || !map.first_not_free(back[i - 1], back[i]));
}

}  // namespace
}  // namespace karst::core
