// No query of free space and no path leaves the region, whatever the map and the region.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core_stack/mapping/frontiers/frontiers.h"
#include "core_stack/mapping/region/flight_region.h"
#include "core_stack/planning/free_space/escape.h"
#include "core_stack/planning/free_space/free_tiles.h"
#include "core_stack/planning/planner.h"
#include "core_stack/planning/search/grid_planner.h"
#include "tests/unit/planning/oracles.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

using testing::all_cells;
using testing::draw;
using testing::random_map;

/// A region through the middle of a map of `size` cells: a box, and a box to keep out of.
std::shared_ptr<const FlightRegion> random_region(Random& random, const CellKey& size) {
  const auto between = [&](double low, double high) {
    return Vec3(0.2 * size.x * random.uniform(low, high), 0.2 * size.y * random.uniform(low, high),
                0.2 * size.z * random.uniform(low, high));
  };
  FlightRegion::Limits limits;
  limits.margin_m = random.uniform(0, 0.4);
  if (random.uniform() < 0.8) limits.keep_in = box(between(-0.2, 0.3), between(0.6, 1.2));
  const Vec3 middle = between(0, 1);
  if (random.uniform() < 0.8)
    limits.keep_out.push_back(
        box(middle - Vec3::Constant(random.uniform(0.1, 0.6)), middle + Vec3::Constant(0.3)));
  return std::make_shared<const FlightRegion>(limits);
}

/// The same map with all cells that the vehicle must not fly in as rock.
VoxelMap walled(const VoxelMap& map, const FlightRegion& region) {
  VoxelMap out{MapOptions{}};
  map.for_each_known([&](const CellKey& k, Cell c, float) {
    out.assign(k, 1, c == Cell::free && region.may_fly(map.center_of(k)) ? -1.0f : 1.0f);
  });
  return out;
}

Vec3 point_around(Random& random, const CellKey& size) {
  return {random.uniform(-0.3, 0.2 * size.x + 0.3), random.uniform(-0.3, 0.2 * size.y + 0.3),
          random.uniform(-0.3, 0.2 * size.z + 0.3)};
}

TEST(Region, FreeSpaceIsThatOfAMapWithRockOutside) {
  const CellKey size{16, 14, 10};
  int clear = 0, blocked = 0;
  EXPECT_TRUE(rc::check([&](std::uint64_t seed) {
    Random random(seed);
    VoxelMap map = random_map(random.bits(), size, 0.01);
    const auto region = random_region(random, size);
    const VoxelMap rock = walled(map, *region);
    map.confine(region);
    FreeTiles free(map.resolution_m()), refreshed(map.resolution_m()), expected(map.resolution_m());
    for (FreeTiles* tiles : {&free, &expected})
      tiles->load(tiles == &free ? map : rock, {-12, -12, -12}, {40, 40, 40});
    map.for_each_known([&](const CellKey& k, Cell, float) {
      refreshed.refresh(map, k);
      RC_ASSERT(free.at(k) == expected.at(k));
      RC_ASSERT(refreshed.at(k) == expected.at(k));
      RC_ASSERT(map.may_fly(k) == expected.at(k));
    });
    for (int i = 0; i < 30; ++i) {
      const Vec3 a = point_around(random, size), b = a + 0.4 * (point_around(random, size) - a);
      const double clearance = random.uniform(0.05, 0.6);
      const bool is = segment_clear(rock, a, b, clearance);
      RC_ASSERT(segment_clear(map, a, b, clearance) == is);
      RC_ASSERT(free.segment_clear(a, b, clearance) == is);
      ++(is ? clear : blocked);
    }
  }));
  EXPECT_GT(clear, 100);
  EXPECT_GT(blocked, 100);
}

TEST(Region, NoPathLeavesIt) {
  const CellKey size{26, 24, 12};
  int found = 0;
  EXPECT_TRUE(rc::check([&](std::uint64_t seed) {
    Random random(seed);
    VoxelMap map = random_map(random.bits(), size, 0.002);
    const auto region = random_region(random, size);
    map.confine(region);
    Roadmap roadmap(kOptions);
    roadmap.update(map, all_cells(map));
    for (int i = 0; i < 2; ++i) {
      const Vec3 from = point_around(random, size), to = point_around(random, size);
      const Path path = plan(map, roadmap, from, to, kOptions);
      if (!path.found()) {
        RC_ASSERT(!path.reason.empty());
        continue;
      }
      ++found;
      // All centres of cells within the clearance have the margin: a place at most a cell's diagonal less.
      const double least_m =
          region->limits().margin_m + kOptions.clearance_m - 0.05 - 2 * 0.87 * map.resolution_m();
      for (std::size_t k = path.escape_points + 1; k < path.points.size(); ++k)
        for (double t = 0; t <= 1; t += 0.1)
          RC_ASSERT(region->depth_m(path.points[k - 1] + t * (path.points[k] - path.points[k - 1])) >=
                    least_m);
    }
  }));
  EXPECT_GT(found, 10);
}

VoxelMap hall(const CellKey& size) {
  VoxelMap map{MapOptions{}};
  draw(map, {0, 0, 0}, {size.x - 1, size.y - 1, size.z - 1}, [&](const CellKey& k) {
    const bool wall =
        k.x == 0 || k.y == 0 || k.z == 0 || k.x == size.x - 1 || k.y == size.y - 1 || k.z == size.z - 1;
    return wall ? Cell::occupied : Cell::free;
  });
  return map;
}

std::shared_ptr<const FlightRegion> half_of_the_hall() {
  FlightRegion::Limits limits;
  limits.keep_in = box({-1, -1, -1}, {5, 9, 9});
  limits.margin_m = 0.3;
  return std::make_shared<const FlightRegion>(limits);
}

TEST(Region, APlaceOutsideIsRefusedWithItsReason) {
  VoxelMap map = hall({50, 20, 15});
  map.confine(half_of_the_hall());
  Roadmap roadmap(kOptions);
  roadmap.update(map, all_cells(map));
  const Path beyond = plan(map, roadmap, {2, 2, 1.5}, {7, 2, 1.5}, kOptions);
  EXPECT_EQ(beyond.status, PlanStatus::goal_blocked);
  EXPECT_EQ(beyond.reason, "the goal lies outside region.keep_in and its margin");
  const Path beside = plan(map, roadmap, {2, 2, 1.5}, {4.5, 2, 1.5}, kOptions);
  EXPECT_EQ(beside.status, PlanStatus::goal_blocked);
  EXPECT_TRUE(beside.reason.starts_with("region.keep_in is 0.")) << beside.reason;
  EXPECT_TRUE(plan(map, roadmap, {2, 2, 1.5}, {4, 2, 1.5}, kOptions).found());
}

TEST(Region, FromOutsideThePathLeadsBackInside) {
  VoxelMap map = hall({50, 20, 15});
  map.confine(half_of_the_hall());
  Roadmap roadmap(kOptions);
  roadmap.update(map, all_cells(map));
  for (const Vec3& from : {Vec3(8.1, 2, 1.5), Vec3(4.9, 2, 1.5), Vec3(9.4, 0.5, 0.5)}) {
    const Path path = plan(map, roadmap, from, {2, 2, 1.5}, kOptions);
    ASSERT_TRUE(path.found()) << path.reason;
    ASSERT_GT(path.escape_points, 0u);
    double before = -100;
    for (const Vec3& p : path.points) {
      const double depth = map.region()->depth_m(p);
      if (depth < 0.7) {
        EXPECT_GE(depth, before - 1e-9);
      }
      before = depth;
      EXPECT_GT(std::min({p.y() - 0.2, p.z() - 0.2, 3.8 - p.y(), 2.8 - p.z()}), 0.2);
    }
    EXPECT_TRUE(map.region()->may_fly(path.points[path.escape_points]));
  }
}

TEST(Region, WhatIsTooFarOutsideHasNoPathBack) {
  VoxelMap map = hall({150, 20, 15});
  map.confine(half_of_the_hall());
  FreeTiles free(map.resolution_m());
  EXPECT_FALSE(escape_path(map, free, {28, 2, 1.5}, 0.45));
}

/// Without a direction the search would visit most of the 150 000 cells within the distance.
TEST(Region, TheSearchForTheWayBackIsDirectedAndBounded) {
  VoxelMap map = hall({90, 60, 40});
  map.confine(half_of_the_hall());
  const Vec3 from(16, 2, 1.5);
  FreeTiles free(map.resolution_m()), again(map.resolution_m());
  const auto path = path_back_inside(map, free, from, 0.45, 2000);
  ASSERT_TRUE(path);
  EXPECT_LT(path_length_m(*path), -map.region()->depth_m(from) + 1.6) << "straight";
  EXPECT_FALSE(path_back_inside(map, again, from, 0.45, 20));
}

TEST(Region, RockAndUnknownCellsKeepTheirClass) {
  VoxelMap map = hall({50, 20, 15});
  const std::size_t free = map.free_cells(), occupied = map.occupied_cells();
  map.confine(half_of_the_hall());
  EXPECT_EQ(map.free_cells(), free);
  EXPECT_EQ(map.occupied_cells(), occupied);
  EXPECT_EQ(map.at(Vec3(8, 2, 1.5)), Cell::free);
  EXPECT_EQ(map.first_not_free({2, 2, 1.5}, {8, 2, 1.5}), std::nullopt);
}

TEST(Region, FrontiersAreThoseWithBothCellsInside) {
  const CellKey size{16, 14, 10};
  int frontiers_inside = 0;
  EXPECT_TRUE(rc::check([&](std::uint64_t seed) {
    Random random(seed);
    VoxelMap map = random_map(random.bits(), size, 0.05);
    const auto region = random_region(random, size);
    map.confine(region);
    Frontiers frontiers{FrontierOptions{}};
    frontiers.update(map, all_cells(map));
    std::size_t expected = 0;
    map.for_each_known([&](const CellKey& k, Cell c, float) {
      bool is = false;
      if (c == Cell::free && region->contains(map.center_of(k)))
        for (const CellKey& d : {CellKey{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}})
          is |= map.at(k + d) == Cell::unknown && region->contains(map.center_of(k + d));
      RC_ASSERT(frontiers.is_frontier(k) == is);
      expected += is;
    });
    RC_ASSERT(frontiers.cell_count() == expected);
    frontiers_inside += static_cast<int>(expected);
  }));
  EXPECT_GT(frontiers_inside, 100);
}

}  // namespace
}  // namespace karst::core
