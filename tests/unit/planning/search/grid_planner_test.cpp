#include "core_stack/planning/search/grid_planner.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/unit/planning/oracles.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

using testing::draw;
using testing::Obstacles;
using testing::random_map;

constexpr CellKey kRoom{16, 12, 8};

CellKey random_cell(Random& random, const CellKey& size) {
  const auto in = [&](std::int32_t n) {
    return static_cast<std::int32_t>(random.bits() % static_cast<std::uint64_t>(n));
  };
  return {in(size.x), in(size.y), in(size.z)};
}

/// A box of free cells 8 m long in x, 3 m in y and z, with what `rule` adds.
VoxelMap hall(const std::function<Cell(const CellKey&)>& rule) {
  VoxelMap map{MapOptions{}};
  draw(map, {0, 0, 0}, {39, 14, 14}, rule);
  return map;
}

TEST(GridPlanner, LengthIsWithinTheWeightOfDijkstra) {
  int found = 0, without = 0;
  EXPECT_TRUE(rc::check([&](std::uint64_t seed) {
    Random random(seed);
    const VoxelMap map = random_map(random.bits(), kRoom, seed % 2 ? 0.03 : 0.1);
    const Obstacles obstacles(map);
    PlanningOptions options;
    options.clearance_m = 0.3;
    options.heuristic_weight = random.bits() % 2 ? 1.0 : 1.3;
    CellKey from, to;
    bool ends_clear = false;
    for (int i = 0; i < 30 && !ends_clear; ++i) {
      from = random_cell(random, kRoom), to = random_cell(random, kRoom);
      ends_clear = is_clear(map, map.center_of(from), 0.3) && is_clear(map, map.center_of(to), 0.3);
    }
    if (!ends_clear) return;
    const Path path = plan_on_grid(map, map.center_of(from), map.center_of(to), options);
    const std::optional<double> best = testing::dijkstra_m(map, obstacles, kRoom, from, to, 0.3);
    RC_ASSERT(path.found() == (best.has_value()));
    if (!best) {
      ++without;
      RC_ASSERT(!path.reason.empty());
      return;
    }
    ++found;
    RC_ASSERT(path.points.front() == map.center_of(from) && path.points.back() == map.center_of(to));
    RC_ASSERT(path.length_m >= *best - 1e-4);
    RC_ASSERT(path.length_m <= *best * options.heuristic_weight + 1e-4);
    for (std::size_t i = 1; i < path.points.size(); ++i)
      RC_ASSERT(obstacles.distance(path.points[i - 1], path.points[i]) >= 0.3 - 1e-6);
  }));
  EXPECT_GT(found, 20);
  EXPECT_GT(without, 0);
}

TEST(GridPlanner, StartsAndEndsAnywhereInItsCells) {
  const VoxelMap map = hall([](const CellKey&) { return Cell::free; });
  const Vec3 a(0.83, 0.91, 0.77), b(7.11, 2.2, 2.05);
  const Path path = plan_on_grid(map, a, b, kOptions);
  ASSERT_TRUE(path.found()) << path.reason;
  EXPECT_EQ(path.points.front(), a);
  EXPECT_EQ(path.points.back(), b);
  EXPECT_EQ(path.escape_points, 0u);
}

TEST(GridPlanner, UnknownSpaceIsNeverCrossed) {
  for (const Cell wall : {Cell::unknown, Cell::occupied}) {
    const VoxelMap map = hall([wall](const CellKey& k) { return k.x == 20 ? wall : Cell::free; });
    const Path path = plan_on_grid(map, {1, 1.5, 1.5}, {7, 1.5, 1.5}, kOptions);
    EXPECT_EQ(path.status, PlanStatus::no_path);
    EXPECT_FALSE(path.reason.empty());
    EXPECT_TRUE(path.points.empty());
  }
}

TEST(GridPlanner, GoalNearRockIsBlockedAndTheReasonNamesTheDistance) {
  const VoxelMap map = hall([](const CellKey& k) { return k.x == 36 ? Cell::occupied : Cell::free; });
  const Path path = plan_on_grid(map, {1, 1.5, 1.5}, {7.0, 1.5, 1.5}, kOptions);
  EXPECT_EQ(path.status, PlanStatus::goal_blocked);
  EXPECT_NE(path.reason.find("occupied cell 0.30 m from the goal"), std::string::npos) << path.reason;
  EXPECT_EQ(plan_on_grid(map, {1, 1.5, 1.5}, {9.0, 1.5, 1.5}, kOptions).reason,
            "the goal lies in an unknown cell");
  EXPECT_EQ(plan_on_grid(map, {1, 1.5, 1.5}, {NAN, 1.5, 1.5}, kOptions).status, PlanStatus::goal_blocked);
}

TEST(GridPlanner, LeavesATightStartWithGrowingClearance) {
  const VoxelMap map = hall([](const CellKey& k) { return k.y == 0 ? Cell::occupied : Cell::free; });
  const Vec3 start(2.0, 0.32, 1.5);
  const Path path = plan_on_grid(map, start, {7.0, 1.5, 1.5}, kOptions);
  ASSERT_TRUE(path.found()) << path.reason;
  const Obstacles obstacles(map);
  ASSERT_GT(path.escape_points, 0u);
  for (std::size_t i = 0; i < path.escape_points; ++i)
    EXPECT_GE(obstacles.distance(path.points[i + 1]), obstacles.distance(path.points[i]));
  for (std::size_t i = path.escape_points; i < path.points.size(); ++i)
    EXPECT_TRUE(is_clear(map, path.points[i], kOptions.clearance_m));
}

TEST(GridPlanner, StartInRockOrWithoutAWayOutIsBlocked) {
  const VoxelMap map =
      hall([](const CellKey& k) { return k.x == 3 || k.x == 0 ? Cell::occupied : Cell::free; });
  const Path in_rock = plan_on_grid(map, {0.7, 1.5, 1.5}, {7.0, 1.5, 1.5}, kOptions);
  EXPECT_EQ(in_rock.status, PlanStatus::start_blocked);
  EXPECT_NE(in_rock.reason.find("the start lies in an occupied cell"), std::string::npos) << in_rock.reason;
  const Path walled_in = plan_on_grid(map, {0.4, 1.5, 1.5}, {7.0, 1.5, 1.5}, kOptions);
  EXPECT_EQ(walled_in.status, PlanStatus::start_blocked);
  EXPECT_NE(walled_in.reason.find("m from the start"), std::string::npos) << walled_in.reason;
}

TEST(GridPlanner, GivesUpAfterSoManyCells) {
  const VoxelMap map = hall([](const CellKey& k) { return k.x == 20 ? Cell::occupied : Cell::free; });
  PlanningOptions options = kOptions;
  options.max_expansions = 100;
  EXPECT_EQ(plan_on_grid(map, {1, 1.5, 1.5}, {7, 1.5, 1.5}, options).status, PlanStatus::gave_up);
}

TEST(GridPlanner, FirstBlockedSegmentIsTheFirst) {
  const VoxelMap map = hall([](const CellKey& k) { return k.x == 20 ? Cell::occupied : Cell::free; });
  const std::vector<Vec3> line{
      {1, 1.5, 1.5}, {2, 1.5, 1.5}, {3.2, 1.5, 1.5}, {3.8, 1.5, 1.5}, {5.5, 1.5, 1.5}};
  EXPECT_EQ(first_blocked_segment(map, line, 0.45), 2);
  EXPECT_EQ(first_blocked_segment(map, {line[0], line[1]}, 0.45), -1);
  EXPECT_EQ(first_blocked_segment(map, {}, 0.45), -1);
}

}  // namespace
}  // namespace karst::core
