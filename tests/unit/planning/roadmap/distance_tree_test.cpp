#include "core_stack/planning/roadmap/distance_tree.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core_stack/planning/search/grid_planner.h"
#include "tests/unit/planning/oracles.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

using testing::all_cells;
using testing::Obstacles;

/// Two corridors from x = 0 to 12 m, 2 m wide, joined at both ends; the first is the shorter way round.
VoxelMap ring(std::vector<CellChange>& changes) {
  VoxelMap map{MapOptions{}};
  const auto within = [](int v, int low, int high) { return v >= low && v < high; };
  testing::draw(
      map, {-2, -2, -2}, {62, 42, 12},
      [&](const CellKey& k) {
        const bool rooms = within(k.y, 0, 40) && (within(k.x, 0, 10) || within(k.x, 50, 60));
        const bool corridors = within(k.x, 0, 60) && (within(k.y, 0, 10) || within(k.y, 30, 40));
        return (rooms || corridors) && within(k.z, 0, 10) ? Cell::free : Cell::occupied;
      },
      &changes);
  return map;
}

/// Rock fills the corridor between these y at x = 30 (or vanishes).
std::vector<CellChange> rockfall(VoxelMap& map, int y_low, bool rock) {
  std::vector<CellChange> changes;
  for (int z = 0; z < 10; ++z)
    for (int y = y_low; y < y_low + 10; ++y) {
      const CellKey k{30, y, z};
      const Cell before = map.at(k);
      map.assign(k, 1, rock ? 2.0f : -2.0f);
      changes.push_back({k, before, map.at(k)});
    }
  return changes;
}

TEST(DistanceTree, ARockfallIsFlownAroundOrSaidToLeaveNoWay) {
  std::vector<CellChange> changes;
  VoxelMap map = ring(changes);
  Roadmap roadmap{kOptions};
  DistanceTree tree;
  const Vec3 home(1, 1, 1), here(11, 1, 1);
  const auto length = [&](const std::vector<CellChange>& c) {
    roadmap.update(map, c);
    tree.update(roadmap, home);
    return tree.length_m(map, roadmap, here);
  };
  const std::optional<double> straight = length(changes);
  ASSERT_TRUE(straight);
  EXPECT_NEAR(*straight, 10.0, 0.8);
  const std::optional<double> around = length(rockfall(map, 0, true));
  ASSERT_TRUE(around);
  EXPECT_GT(*around, 18.2);  // a taut string round the block between the corridors, 8 x 4 m
  const Path path = tree.find(map, roadmap, here);
  ASSERT_TRUE(path.found()) << path.reason;
  EXPECT_EQ(first_blocked_segment(map, path.points, search_clearance_m(kOptions, 0.2)), -1);
  EXPECT_FALSE(length(rockfall(map, 30, true)));
  EXPECT_FALSE(tree.find(map, roadmap, here).reason.empty());
  EXPECT_EQ(length(rockfall(map, 0, false)), straight);
}

TEST(DistanceTree, AnEstimateIsWithinABlockOfTheLength) {
  std::vector<CellChange> changes;
  const VoxelMap map = ring(changes);
  Roadmap roadmap{kOptions};
  DistanceTree tree;
  roadmap.update(map, changes);
  tree.update(roadmap, {1, 1, 1});
  Random random(1);
  int estimated = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 from(random.uniform(-0.2, 12.2), random.uniform(-0.2, 8.2), random.uniform(0, 2));
    const std::optional<double> length_m = tree.length_m(map, roadmap, from),
                                estimate_m = tree.estimated_length_m(roadmap, from);
    if (!estimate_m) continue;  // not in a clear cell
    ++estimated;
    ASSERT_TRUE(length_m);
    EXPECT_NEAR(*estimate_m, *length_m, 0.8) << from.transpose();
  }
  EXPECT_GT(estimated, 500);
}

TEST(DistanceTree, KeptUpToDateEqualsBuiltFromScratchAndDijkstra) {
  int reached = 0;
  rc::check("distances", [&] {
    Random random(*rc::gen::inRange<std::uint64_t>(1, 1u << 30));
    const auto place = [&] {
      return Vec3(random.uniform(0.5, 6), random.uniform(0.5, 4.5), random.uniform(0.5, 3));
    };
    VoxelMap map{MapOptions{}};
    Roadmap roadmap{kOptions};
    DistanceTree kept;
    const Vec3 root = place();
    for (int step = 0; step < 5; ++step) {
      const CellKey at{static_cast<std::int32_t>(random.bits() % 18),
                       static_cast<std::int32_t>(random.bits() % 12),
                       static_cast<std::int32_t>(random.bits() % 7)};
      const double fraction = 0.02 * static_cast<double>(random.bits() % 3);
      std::vector<CellChange> changes;
      testing::draw(
          map, at, at + CellKey{14, 11, 9},
          [&](const CellKey&) { return random.uniform() < fraction ? Cell::occupied : Cell::free; },
          &changes);
      roadmap.update(map, changes);
      kept.update(roadmap, root);
      DistanceTree built;
      built.update(roadmap, root);
      const double search_m = search_clearance_m(kOptions, map.resolution_m());
      for (int i = 0; i < 6; ++i) {
        const Vec3 from = place();
        const std::optional<double> length_m = kept.length_m(map, roadmap, from);
        RC_ASSERT(length_m == built.length_m(map, roadmap, from));  // to the last bit
        const Path path = kept.find(map, roadmap, from);
        RC_ASSERT(path.found() == length_m.has_value());
        RC_ASSERT(path.points == built.find(map, roadmap, from).points);
        const double dijkstra_m = roadmap.distances(map, from, std::vector{root}, 0.0)[0];
        if (!length_m) {
          RC_ASSERT(!std::isfinite(dijkstra_m) || segment_clear(map, from, root, search_m));
          continue;
        }
        ++reached;
        if (!segment_clear(map, path.points[path.escape_points], root,
                           search_m))  // it looks at those directly
          RC_ASSERT(std::abs(*length_m - dijkstra_m) < 1e-9);
        for (std::size_t k = path.escape_points + 1; k < path.points.size(); ++k)
          RC_ASSERT(segment_clear(map, path.points[k - 1], path.points[k], search_m));
      }
    }
  });
  EXPECT_GT(reached, 20);
}

TEST(DistanceTree, WithoutARoadmapOrAClearRootThereIsNoWay) {
  const VoxelMap map = testing::random_map(1, {30, 22, 16}, 0.0);
  Roadmap roadmap{kOptions};
  DistanceTree tree;
  tree.update(roadmap, {2, 2, 2});
  EXPECT_FALSE(tree.length_m(map, roadmap, {3, 2, 2}));
  roadmap.update(map, all_cells(map));
  tree.update(roadmap, {0.1, 2, 2});  // at the unknown's border
  EXPECT_FALSE(tree.length_m(map, roadmap, {3, 2, 2}));
  EXPECT_FALSE(tree.find(map, roadmap, {3, 2, 2}).found());
}

}  // namespace
}  // namespace karst::core
