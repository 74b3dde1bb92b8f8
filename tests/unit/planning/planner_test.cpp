#include "core_stack/planning/planner.h"

#include <gtest/gtest.h>

#include "core_stack/planning/search/grid_planner.h"
#include "tests/unit/planning/oracles.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

using testing::all_cells;
using testing::Obstacles;
using testing::WindingCave;

Roadmap roadmap_of(const VoxelMap& map) {
  Roadmap roadmap{kOptions};
  roadmap.update(map, all_cells(map));
  return roadmap;
}

/// A corridor with a right-angled bend, its walls at y0 and y0 + width (then the same in x), height alike.
/// A cell is rock when a wall's surface runs through it or it lies behind.
VoxelMap bent_corridor(double width, const Vec3& shift) {
  VoxelMap map{MapOptions{}};
  const auto inside = [&](const Vec3& p) {
    const Vec3 q = p - shift;
    const bool first = q.x() > 0 && q.x() < 5 && q.y() > 0 && q.y() < width;
    const bool second = q.x() > 5 - width && q.x() < 5 && q.y() > 0 && q.y() < 5;
    return (first || second) && q.z() > 0 && q.z() < width;
  };
  testing::draw(map, {-4, -4, -4}, {30, 30, 12}, [&](const CellKey& k) {
    const Vec3 low = map.center_of(k) - Vec3::Constant(0.0999);
    for (int i = 0; i < 8; ++i)
      if (!inside(low + 0.1998 * Vec3(i & 1, i >> 1 & 1, i >> 2))) return Cell::occupied;
    return Cell::free;
  });
  return map;
}

TEST(Planner, PassesABentCorridorHalfAMetreWiderThanTheVehicleHoweverItLiesInTheGrid) {
  for (int i = 0; i < 8; i += 2) {
    const Vec3 shift(0.025 * i, 0.2 - 0.025 * i, 0.0125 * i);
    const VoxelMap map = bent_corridor(1.1, shift);
    const Roadmap roadmap = roadmap_of(map);
    const Vec3 a = shift + Vec3(0.8, 0.55, 0.55), b = shift + Vec3(4.45, 4.2, 0.55);
    const Path path = plan(map, roadmap, a, b, kOptions);
    ASSERT_TRUE(path.found()) << i << ": " << path.reason;
    const Obstacles obstacles(map);
    for (std::size_t k = std::max<std::size_t>(1, path.escape_points + 1); k < path.points.size(); ++k)
      EXPECT_GE(obstacles.distance(path.points[k - 1], path.points[k]), 0.45 - 1e-6);
  }
}

TEST(Planner, RefusesACorridorInWhichTheVehicleHasNoMargin) {
  for (int i = 0; i < 4; ++i) {
    const Vec3 shift(0.05 * i, 0.05 * i, 0.0);
    const VoxelMap map = bent_corridor(0.75, shift);
    const Roadmap roadmap = roadmap_of(map);
    EXPECT_FALSE(
        plan(map, roadmap, shift + Vec3(0.8, 0.37, 0.37), shift + Vec3(4.6, 4.2, 0.37), kOptions).found());
  }
}

TEST(Planner, FarPathsAreClearAndBarelyLongerThanTheShortest) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const WindingCave cave = WindingCave::of_length(30, seed, 1.5);
    const VoxelMap map = cave.map();
    const Roadmap roadmap = roadmap_of(map);
    const Vec3 a = cave.line[4], b = cave.line[cave.line.size() - 5];
    const Path path = plan(map, roadmap, a, b, kOptions);
    ASSERT_TRUE(path.found()) << path.reason;
    EXPECT_EQ(path.points.front(), a);
    EXPECT_EQ(path.points.back(), b);
    EXPECT_EQ(first_blocked_segment(map, path.points, kOptions.clearance_m), -1);
    PlanningOptions optimal = kOptions;
    optimal.heuristic_weight = 1.0;
    EXPECT_LT(path.length_m, 1.03 * plan_on_grid(map, a, b, optimal).length_m);
  }
}

TEST(Planner, WhatTheRoadmapConnectsCanBeFlown) {
  const PlanningOptions options;
  int connected = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const VoxelMap map = testing::random_map(seed, {30, 30, 18}, 0.008);
    Roadmap roadmap{options};
    roadmap.update(map, all_cells(map));
    const Obstacles obstacles(map);
    Random random(seed);
    for (int i = 0; i < 12; ++i) {
      const auto inside = [&](double size_m) { return random.uniform(0.6, size_m - 0.6); };
      const Vec3 a(inside(6), inside(6), inside(3.6)), b(inside(6), inside(6), inside(3.6));
      if (!is_clear(map, a, search_clearance_m(options, 0.2)) || !is_clear(map, b, options.clearance_m) ||
          !roadmap.find(map, a, b).found())
        continue;
      ++connected;
      const Path path = plan(map, roadmap, a, b, options);
      ASSERT_TRUE(path.found()) << seed << ": " << path.reason;
      const double min_m = path.narrow() ? search_clearance_m(options, 0.2) : options.clearance_m;
      for (std::size_t k = path.escape_points + 1; k < path.points.size(); ++k)
        EXPECT_GE(obstacles.distance(path.points[k - 1], path.points[k]), min_m - 1e-6) << seed;
    }
  }
  EXPECT_GT(connected, 20);
}

TEST(Planner, SameInputsGiveTheSameBytes) {
  const WindingCave cave = WindingCave::of_length(30, 5, 1.5);
  const VoxelMap map = cave.map();
  const Roadmap roadmap = roadmap_of(map);
  const Path one = plan(map, roadmap, cave.line[4], cave.line[50], kOptions);
  const Path two = plan(map, roadmap, cave.line[4], cave.line[50], kOptions);
  ASSERT_TRUE(one.found());
  EXPECT_EQ(one.points, two.points);
}

TEST(Planner, SaysWhyThereIsNoPath) {
  const WindingCave cave = WindingCave::of_length(15, 2, 1.5);
  const VoxelMap map = cave.map();
  const Roadmap roadmap = roadmap_of(map);
  EXPECT_EQ(plan(map, roadmap, cave.line[4], {0, 0, 50}, kOptions).status, PlanStatus::goal_blocked);
  EXPECT_EQ(plan(map, roadmap, {0, 0, 50}, cave.line[4], kOptions).status, PlanStatus::start_blocked);
  for (const Path& p : {plan(map, roadmap, cave.line[4], {0, 0, 50}, kOptions),
                        plan(map, roadmap, {0, 0, 50}, cave.line[4], kOptions)})
    EXPECT_FALSE(p.reason.empty());
}

}  // namespace
}  // namespace karst::core
