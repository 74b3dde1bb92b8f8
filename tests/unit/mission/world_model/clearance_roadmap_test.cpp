#include "core_stack/mission/world_model/clearance_roadmap.h"

#include <gtest/gtest.h>

#include "core_stack/planning/planner.h"
#include "core_stack/planning/search/grid_planner.h"
#include "tests/unit/mission/drawn_map.h"

namespace karst::core {
namespace {

/// Two rooms of 4 x 4 x 3 m and a corridor of 3 m x 0.8 m x 1.4 m of free cells between them.
VoxelMap two_rooms() {
  VoxelMap map{MapOptions{}};
  carve_box(map, Vec3(0, 0, 0), Vec3(4, 4, 3));
  carve_box(map, Vec3(7, 0, 0), Vec3(11, 4, 3));
  const CellKey a = map.key_of(Vec3(3.7, 1.5, 0.7)), b = map.key_of(Vec3(7.3, 2.1, 1.9));
  for (int x = a.x; x <= b.x; ++x)
    for (int y = a.y; y <= b.y; ++y)
      for (int z = a.z; z <= b.z; ++z) map.assign({x, y, z}, 1, -1.0f);
  return map;
}

const Vec3 kHere(2, 2, 1.4), kThere(9, 2, 1.4);

TEST(NarrowRoadmap, LeadsWhereTheUsualClearanceDoesNot) {
  const VoxelMap map = two_rooms();
  PlanningOptions options;
  options.narrow_margin_m = 0.08;
  ClearanceRoadmap usual = narrow_roadmap(map, options, options.clearance_m);
  usual.update(map, kHere);
  EXPECT_FALSE(plan(map, usual.roadmap(), kHere, kThere, usual.planning()).found());
  EXPECT_FALSE(usual.home_length_m(map, kThere));

  const auto clearance_m = narrow_clearance_m(options, 0.3);
  ASSERT_TRUE(clearance_m);
  ClearanceRoadmap narrow = narrow_roadmap(map, options, *clearance_m);
  narrow.update(map, kHere);
  Path path = plan(map, narrow.roadmap(), kHere, kThere, narrow.planning());
  ASSERT_TRUE(path.found()) << path.reason;
  mark_narrow_places(map, options.clearance_m, path);
  ASSERT_TRUE(path.narrow());
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    const Vec3 &a = path.points[i - 1], &b = path.points[i];
    EXPECT_TRUE(segment_clear(map, a, b, path.clear_by_m));
    EXPECT_TRUE(segment_clear(map, a, b, options.clearance_m) || near_narrow_place(path.narrow_places, a, b));
  }
  EXPECT_GE(path.clear_by_m, 0.3);
  for (const Vec3& p : path.narrow_places) EXPECT_NEAR(p.x(), 5.5, 2.6) << "only the corridor is narrow";
  EXPECT_NEAR(narrow.home_length_m(map, kThere).value_or(0), 7, 1);
}

TEST(NarrowRoadmap, IsThereOnlyIfTheOptionsAskForLessThanTheUsualClearance) {
  PlanningOptions options;
  EXPECT_FALSE(narrow_clearance_m(options, 0.3)) << "off by default";
  options.narrow_margin_m = 0.08;
  EXPECT_NEAR(narrow_clearance_m(options, 0.3).value_or(0), 0.38, 1e-12);
  options.narrow_margin_m = 0.3;
  EXPECT_FALSE(narrow_clearance_m(options, 0.3)) << "that is the usual clearance";
}

TEST(NarrowPlaces, AreFoundAllAlongALongSegment) {
  const VoxelMap map = two_rooms();
  Path path;
  path.points = {Vec3(3, 2, 1.4), Vec3(8, 2, 1.4)};
  mark_narrow_places(map, 0.6, path);
  EXPECT_GE(path.narrow_places.size(), 6u);
  for (double x = 4.2; x < 6.8; x += 0.1)
    EXPECT_TRUE(near_narrow_place(path.narrow_places, Vec3(x, 2, 1.4), Vec3(x, 2, 1.4))) << x;
  EXPECT_FALSE(near_narrow_place(path.narrow_places, Vec3(1, 2, 1.4), Vec3(1.5, 2, 1.4)));
}

TEST(RoadmapPlaces, NearAPointAreClearNodesWithinReach) {
  const VoxelMap map = two_rooms();
  ClearanceRoadmap narrow = narrow_roadmap(map, PlanningOptions{}, 0.38);
  narrow.update(map, kHere);
  const std::vector<Vec3> all = narrow.roadmap().places_near(Vec3(5.5, 2, 1.5), 100);
  EXPECT_EQ(all.size(), narrow.roadmap().node_count());
  const std::vector<Vec3> near = narrow.roadmap().places_near(Vec3(5.5, 2, 1.5), 1.5);
  EXPECT_EQ(near.size(), static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [](const Vec3& p) {
              return (p - Vec3(5.5, 2, 1.5)).norm() <= 1.5;
            })));
  EXPECT_GE(near.size(), 2u) << "the corridor has nodes";
  EXPECT_TRUE(narrow.roadmap().places_near(Vec3(1e9, 0, 0), 1).empty());
}

}  // namespace
}  // namespace karst::core
