#include "core_stack/planning/roadmap/roadmap.h"

#include <gtest/gtest.h>

#include "core_stack/planning/search/grid_planner.h"
#include "tests/unit/planning/oracles.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

using testing::all_cells;
using testing::Obstacles;
using testing::random_map;
using testing::WindingCave;

constexpr CellKey kHall{30, 22, 16};

Vec3 point_in(Random& random) {
  return {random.uniform(0.3, 0.2 * kHall.x - 0.3), random.uniform(0.3, 0.2 * kHall.y - 0.3),
          random.uniform(0.3, 0.2 * kHall.z - 0.3)};
}

TEST(Roadmap, ReachesExactlyWhatTheGridReaches) {
  int reached = 0, not_reached = 0;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    Random random(seed);
    const VoxelMap map = random_map(random.bits(), kHall, 0.015 * static_cast<double>(1 + seed % 3));
    const Obstacles obstacles(map);
    Roadmap roadmap{kOptions};
    roadmap.update(map, all_cells(map));
    const double search_m = search_clearance_m(kOptions, map.resolution_m());
    std::vector<Vec3> places;
    for (int i = 0; i < 200 && places.size() < 5; ++i)
      if (const Vec3 p = point_in(random); is_clear(map, p, search_m)) places.push_back(p);
    if (places.size() < 2) continue;
    const Vec3 from = places.back();
    places.pop_back();
    const std::vector<double> lengths = roadmap.distances(map, from, places, 0.0);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Path grid = plan_on_grid_squeezing(map, from, places[i], kOptions);
      const Path path = roadmap.find(map, from, places[i]);
      // A point may see a neighbouring node directly, in a place where the grid finds no cell at all.
      ASSERT_TRUE(!grid.found() || (std::isfinite(lengths[i]) && path.found()));
      ASSERT_TRUE(path.found() || !std::isfinite(lengths[i]) ||
                  segment_clear(map, from, places[i], search_m));
      (grid.found() ? reached : not_reached) += 1;
      if (!path.found()) continue;
      ASSERT_TRUE(path.points.front() == from && path.points.back() == places[i]);
      for (std::size_t k = 1; k < path.points.size(); ++k)
        ASSERT_TRUE(obstacles.distance(path.points[k - 1], path.points[k]) >= search_m - 1e-6);
      ASSERT_TRUE(std::abs(path.length_m - path_length_m(path.points)) < 1e-9);
      ASSERT_TRUE(lengths[i] >= (places[i] - from).norm() - 1e-9);
    }
  }
  EXPECT_GT(reached, 40);
  EXPECT_GT(not_reached, 5);
}

TEST(Roadmap, UpdatedFromChangesEqualsBuiltFromScratch) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    VoxelMap map{MapOptions{}};
    Roadmap grown{kOptions};
    for (int step = 0; step < 6; ++step) {
      // Boxes of free space, then rock that appears in them, and rock that turns out free.
      const CellKey at{static_cast<std::int32_t>(random.bits() % 20),
                       static_cast<std::int32_t>(random.bits() % 14),
                       static_cast<std::int32_t>(random.bits() % 8)};
      const double fraction = 0.02 * static_cast<double>(random.bits() % 3);
      std::vector<CellChange> changes;
      testing::draw(
          map, at, at + CellKey{12, 9, 8},
          [&](const CellKey&) { return random.uniform() < fraction ? Cell::occupied : Cell::free; },
          &changes);
      grown.update(map, changes);
    }
    Roadmap built{kOptions};
    built.update(map, all_cells(map));
    ASSERT_TRUE(grown.node_count() == built.node_count());
    std::vector<Vec3> goals;
    for (int i = 0; i < 12; ++i) goals.push_back(point_in(random));
    const std::vector<double> a = grown.distances(map, goals[0], goals, 0.4),
                              b = built.distances(map, goals[0], goals, 0.4);
    for (std::size_t i = 0; i < a.size(); ++i) ASSERT_TRUE(a[i] == b[i] || std::abs(a[i] - b[i]) < 1e-9);
  }
}

TEST(Roadmap, AnswersAreTheSameWhetherOrNotItWasAskedBefore) {
  int found = 0, lost = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    VoxelMap map{MapOptions{}};
    Roadmap asked{kOptions};
    std::vector<std::vector<CellChange>> history;
    std::vector<Vec3> goals;
    for (int i = 0; i < 12; ++i) goals.push_back(point_in(random));
    std::vector<double> before(goals.size(), std::numeric_limits<double>::infinity());
    for (int step = 0; step < 12; ++step) {
      // Free space near and far, and rock that appears in it.
      const CellKey at{static_cast<std::int32_t>(random.bits() % 26),
                       static_cast<std::int32_t>(random.bits() % 18),
                       static_cast<std::int32_t>(random.bits() % 10)};
      const CellKey size = step < 6 ? CellKey{14, 11, 9} : CellKey{3, 3, 3};
      const double fraction = step < 6 ? 0.005 : 0.5;
      testing::draw(
          map, at, at + size,
          [&](const CellKey&) { return random.uniform() < fraction ? Cell::occupied : Cell::free; },
          &history.emplace_back());
      asked.update(map, history.back());
      Roadmap fresh{kOptions};
      for (const std::vector<CellChange>& changes : history) fresh.update(map, changes);
      const std::vector<double> lengths = asked.distances(map, goals[0], goals, 0.4);
      EXPECT_EQ(lengths, fresh.distances(map, goals[0], goals, 0.4));
      EXPECT_EQ(asked.find(map, goals[0], goals[1]).points, fresh.find(map, goals[0], goals[1]).points);
      for (std::size_t i = 0; i < goals.size(); ++i) {
        found += std::isfinite(lengths[i]) && lengths[i] != before[i];
        lost += !std::isfinite(lengths[i]) && std::isfinite(before[i]);
      }
      before = lengths;
    }
  }
  EXPECT_GT(found, 100);
  EXPECT_GT(lost, 5);
}

TEST(Roadmap, EquallyShortPathsAreChosenByPlaceInARebuiltRoadmapToo) {
  const VoxelMap map = random_map(5, kHall, 0.005);
  const std::vector<CellChange> cells = all_cells(map);
  Roadmap forwards{kOptions}, backwards{kOptions};
  forwards.update(map, cells);
  const std::vector<CellChange> reversed(cells.rbegin(), cells.rend());
  const auto half = static_cast<std::ptrdiff_t>(reversed.size() / 2);
  backwards.update(map, std::vector<CellChange>(reversed.begin(), reversed.begin() + half));
  backwards.update(map, std::vector<CellChange>(reversed.begin() + half, reversed.end()));
  Random random(5);
  int found = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec3 from = point_in(random), to = point_in(random);
    const Path a = forwards.find(map, from, to, EqualPaths::by_place),
               b = backwards.find(map, from, to, EqualPaths::by_place);
    ASSERT_EQ(a.status, b.status);
    EXPECT_EQ(a.points, b.points);
    found += a.found();
  }
  EXPECT_GT(found, 5);
}

TEST(Roadmap, LeastClearanceIsTheDistanceToTheNearestObstacleAlongTheLine) {
  const VoxelMap map = random_map(3, kHall, 0.005);
  const Obstacles obstacles(map);
  Roadmap roadmap{kOptions};
  EXPECT_EQ(roadmap.least_clearance_m(std::vector<Vec3>{{1, 1, 1}}), 0) << "nothing is known";
  roadmap.update(map, all_cells(map));
  EXPECT_EQ(roadmap.least_clearance_m({}), 0);
  const double eighth_m = 0.125 * map.resolution_m();
  Random random(3);
  int compared = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 a = point_in(random), b = point_in(random);
    const double expected_m = obstacles.distance(a, b);
    if (expected_m < 0) continue;  // it leads through rock
    ++compared;
    const double least_m = roadmap.least_clearance_m(std::vector<Vec3>{a, b});
    EXPECT_GE(least_m, expected_m - 1e-9);
    EXPECT_LE(least_m, expected_m + eighth_m + 1e-9);
  }
  EXPECT_GT(compared, 10);
}

TEST(Roadmap, LengthsAreNearTheGridsShortest) {
  const WindingCave cave = WindingCave::of_length(25, 3, 1.5);
  std::vector<CellChange> changes;
  const VoxelMap map = cave.map(&changes);
  Roadmap roadmap{kOptions};
  roadmap.update(map, changes);
  PlanningOptions optimal = kOptions;
  optimal.heuristic_weight = 1.0;
  const Vec3 from = cave.line[4];
  std::vector<Vec3> goals;
  for (std::size_t i = 12; i + 4 < cave.line.size(); i += 8) goals.push_back(cave.line[i]);
  const std::vector<double> lengths = roadmap.distances(map, from, goals, 0.0);
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const Path best = plan_on_grid(map, from, goals[i], optimal);
    ASSERT_TRUE(best.found()) << best.reason;
    EXPECT_LT(lengths[i], 1.2 * best.length_m);
    EXPECT_GT(lengths[i], 0.85 * best.length_m);  // an octile way is up to 13 % longer than a straight one
  }
}

TEST(Roadmap, AGoalInTheCornerIsApproachedWithinItsTolerance) {
  const VoxelMap map = random_map(1, kHall, 0.0);  // a box of free cells in the unknown
  Roadmap roadmap{kOptions};
  roadmap.update(map, all_cells(map));
  const Vec3 corner(0.12, 2.0, 1.5), from(3, 2, 1.5);
  EXPECT_FALSE(roadmap.approach(map, corner, 0.1).has_value());
  const std::optional<Vec3> place = roadmap.approach(map, corner, 0.8);
  ASSERT_TRUE(place.has_value());
  EXPECT_LE((*place - corner).norm(), 0.8);
  EXPECT_TRUE(is_clear(map, *place, 0.4));
  EXPECT_TRUE(std::isinf(roadmap.distances(map, from, std::vector{corner}, 0.1)[0]));
  EXPECT_NEAR(roadmap.distances(map, from, std::vector{corner}, 0.8)[0], (*place - from).norm(), 1e-9);
}

TEST(Roadmap, EmptyOrBlockedGivesReasons) {
  const VoxelMap map = random_map(1, kHall, 0.0);
  const Roadmap empty{kOptions};
  EXPECT_EQ(empty.node_count(), 0u);
  EXPECT_FALSE(empty.find(map, {1, 1, 1}, {2, 2, 2}).reason.empty());
  EXPECT_TRUE(std::isinf(empty.distances(map, {1, 1, 1}, std::vector<Vec3>{{2, 2, 2}}, 0.5)[0]));
  Roadmap roadmap{kOptions};
  roadmap.update(map, all_cells(map));
  EXPECT_EQ(roadmap.find(map, {3, 2, 1.5}, {-3, 2, 1.5}).status, PlanStatus::goal_blocked);
  EXPECT_EQ(roadmap.find(map, {-3, 2, 1.5}, {3, 2, 1.5}).status, PlanStatus::start_blocked);
}

/// The same by looking at every node.
std::optional<Vec3> nearest_that_sees(const VoxelMap& map, const Roadmap& roadmap, const Vec3& goal,
                                      double tolerance_m) {
  std::optional<Vec3> best;
  for (const Vec3& p : roadmap.places_near(Vec3(3, 2, 1.6), 50))
    if (const double d = (p - goal).norm();
        d <= tolerance_m && (!best || d < (*best - goal).norm()) && !map.first_not_free(p, goal))
      best = p;
  return best;
}

TEST(Roadmap, ApproachesTheNearestNodeThatSeesTheGoalWhateverTheTolerance) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    const VoxelMap map = random_map(random.bits(), kHall, 0.015 * static_cast<double>(1 + seed % 3));
    Roadmap roadmap{kOptions};
    roadmap.update(map, all_cells(map));
    const double search_m = search_clearance_m(kOptions, map.resolution_m());
    for (int i = 0; i < 40; ++i) {
      const Vec3 goal = point_in(random);
      if (is_clear(map, goal, search_m)) continue;
      for (const double tolerance_m : {0.0, 0.5, 2.0, 5.0, 100.0}) {
        const std::optional<Vec3> place = roadmap.approach(map, goal, tolerance_m),
                                  oracle = nearest_that_sees(map, roadmap, goal, tolerance_m);
        ASSERT_EQ(place.has_value(), oracle.has_value()) << seed << ' ' << tolerance_m;
        if (!place) continue;
        ASSERT_NEAR((*place - goal).norm(), (*oracle - goal).norm(), 1e-12);
        ++found;
      }
    }
  }
  EXPECT_GT(found, 100);
}

TEST(Roadmap, NodesNearAPlaceComeInTheSameOrderFromFarAndFromNear) {
  const VoxelMap map = random_map(5, kHall, 0.02);
  Roadmap roadmap{kOptions};
  roadmap.update(map, all_cells(map));
  const Vec3 p(3, 2, 1.6);
  const std::vector<Vec3> near = roadmap.places_near(p, 2.0);  // block by block
  std::vector<Vec3> far;
  for (const Vec3& q : roadmap.places_near(p, 200))  // tile by tile
    if ((q - p).norm() <= 2.0) far.push_back(q);
  ASSERT_GT(near.size(), 10u);
  EXPECT_EQ(near, far);
}

TEST(Roadmap, StopsAtTheWorkItMayDoWhateverIsAsked) {
  const VoxelMap map = random_map(3, kHall, 0.02);
  Roadmap roadmap{kOptions};
  roadmap.update(map, all_cells(map));
  Random random(1);
  std::vector<Vec3> goals;
  for (int i = 0; i < 500; ++i) goals.push_back(point_in(random));
  const Vec3 from = roadmap.places_near(Vec3(3, 2, 1.6), 3).front();
  WorkBudget ample(100'000'000), scarce(20'000);
  const std::vector<double> whole = roadmap.distances(map, from, goals, 100, 1e9, &ample);
  EXPECT_FALSE(ample.exhausted());
  EXPECT_LT(ample.left(), 100'000'000u);
  EXPECT_EQ(whole, roadmap.distances(map, from, goals, 100));
  roadmap.distances(map, from, goals, 100, 1e9, &scarce);
  EXPECT_TRUE(scarce.exhausted());
}

}  // namespace
}  // namespace karst::core
