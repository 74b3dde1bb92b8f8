// What counts as clear, against brute force over all cells.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core_stack/common/error.h"
#include "core_stack/planning/free_space/free_tiles.h"
#include "core_stack/planning/search/grid_planner.h"
#include "tests/unit/planning/oracles.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

using testing::Obstacles;
using testing::random_map;

constexpr CellKey kSize{14, 12, 10};

Vec3 point_in(Random& random, const CellKey& size) {
  return {random.uniform(-0.3, 0.2 * size.x + 0.3), random.uniform(-0.3, 0.2 * size.y + 0.3),
          random.uniform(-0.3, 0.2 * size.z + 0.3)};
}

TEST(Clearance, SegmentIsClearExactlyWhenBruteForceSaysSo) {
  int clear = 0;
  EXPECT_TRUE(rc::check([&clear](std::uint64_t seed) {
    Random random(seed);
    const VoxelMap map = random_map(random.bits(), kSize, 0.02);
    const Obstacles obstacles(map);
    FreeTiles free(map.resolution_m());
    free.load(map, {-12, -12, -12}, {40, 40, 40});
    for (int i = 0; i < 30; ++i) {
      const Vec3 a = point_in(random, kSize),
                 b = i % 3 == 0 ? a : Vec3(a + 0.3 * (point_in(random, kSize) - a));
      const double clearance = random.uniform(0.2, 0.7);
      const bool expected = obstacles.distance(a, b) >= clearance;
      RC_ASSERT(segment_clear(map, a, b, clearance) == expected);
      RC_ASSERT(free.segment_clear(a, b, clearance) == expected);
      clear += expected;
    }
  }));
  EXPECT_GT(clear, 100);
}

TEST(Clearance, NearestObstacleIsTheNearestOccupiedOrUnknownBorderCell) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random random(seed);
    const VoxelMap map = random_map(random.bits(), kSize, 0.03);
    const Obstacles obstacles(map);
    FreeTiles free(map.resolution_m());
    free.load(map, {-12, -12, -12}, {40, 40, 40});
    for (int i = 0; i < 30; ++i) {
      const Vec3 p = point_in(random, kSize);
      if (map.at(p) != Cell::free) continue;
      const double expected = obstacles.distance(p);
      RC_ASSERT(std::abs(free.nearest(p, 1.4).distance_m - std::min(expected, 1.4)) < 1e-9);
    }
  }));
}

TEST(Clearance, CellsOfATileAreClearExactlyWhenTheirCentreIs) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Random random(seed);
    const VoxelMap map = random_map(random.bits(), {36, 12, 10}, 0.01);
    const Obstacles obstacles(map);
    FreeTiles free(map.resolution_m());
    free.load(map, {-40, -20, -20}, {80, 40, 40});
    const double clearance = 0.3 + 0.05 * static_cast<double>(random.bits() % 6);
    const ClearanceRule rule(clearance / 0.2);
    for (const TileKey t : {TileKey{0, 0, 0}, TileKey{1, 0, 0}, TileKey{0, 1, 0}, TileKey{0, 0, 1}}) {
      const TileBits clear = free.clear_cells(t, rule);
      for (std::uint32_t i = 0; i < kTileCells; ++i) {
        const CellKey k = cell_in_tile(corner_of(t), i);
        const bool got = clear[i >> 5] >> (i & 31) & 1;
        const double distance = obstacles.distance(map.center_of(k), map.center_of(k));
        // A centre within rounding of the clearance may go either way.
        ASSERT_TRUE(got == (distance >= clearance) || std::abs(distance - clearance) <= 1e-5);
      }
    }
  }
}

TEST(Clearance, MovesBetweenClearCellsAreClear) {
  // 0.43 and 0.6 are radii at which a diagonal move comes nearer to a cell than both its ends.
  for (const double clearance : {0.3, 0.43, 0.45, 0.55, 0.6}) {
    const VoxelMap map = random_map(7, {32, 10, 10}, 0.006);
    const Obstacles obstacles(map);
    FreeTiles free(map.resolution_m());
    free.load(map, {-20, -20, -20}, {50, 40, 40});
    const TileBits clear = free.clear_cells({0, 0, 0}, ClearanceRule(clearance / 0.2));
    const auto is_clear_cell = [&clear](const CellKey& k) {
      return clear[row_of(k.y, k.z)] >> (k.x & 31) & 1;
    };
    int moves = 0;
    for (std::uint32_t i = 0; i < kTileCells; ++i) {
      const CellKey k = cell_in_tile({0, 0, 0}, i);
      for (int m = 0; m < 27; ++m) {
        const CellKey n = k + CellKey{m % 3 - 1, m / 3 % 3 - 1, m / 9 - 1};
        if (!(tile_of(n) == TileKey{0, 0, 0}) || !is_clear_cell(k) || !is_clear_cell(n)) continue;
        ++moves;
        ASSERT_GE(obstacles.distance(map.center_of(k), map.center_of(n)), clearance - 1e-6);
      }
    }
    EXPECT_GT(moves, 100) << clearance;
  }
}

TEST(Clearance, SqueezingAddsCellsBesideWhichAHalfCellPointIsClear) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Random random(seed);
    const VoxelMap map = random_map(random.bits(), {34, 12, 10}, 0.015);
    const Obstacles obstacles(map);
    FreeTiles free(map.resolution_m());
    free.load(map, {-40, -20, -20}, {80, 40, 40});
    const double clearance = 0.45, search = 0.4;
    const TileBits got = free.clear_cells({0, 0, 0}, ClearanceRule(clearance / 0.2, search / 0.2));
    for (std::uint32_t i = 0; i < kTileCells; ++i) {
      const CellKey k = cell_in_tile({0, 0, 0}, i);
      const Vec3 p = map.center_of(k);
      bool expected = obstacles.distance(p, p) >= clearance - 1e-6;
      if (!expected && obstacles.distance(p, p) >= search - 1e-6)
        for (int m = 0; m < 27 && !expected; ++m) {
          const Vec3 q = p + 0.1 * Vec3(m % 3 - 1, m / 3 % 3 - 1, m / 9 - 1);
          expected = obstacles.distance(q, q) >= clearance - 1e-6;
        }
      ASSERT_TRUE(static_cast<bool>(got[i >> 5] >> (i & 31) & 1) == expected);
    }
  }
}

TEST(Clearance, PointsFarAwayOrNotFiniteAreNotClear) {
  const VoxelMap map = random_map(1, kSize, 0.0);
  const Obstacles obstacles(map);
  EXPECT_TRUE(is_clear(map, {1.4, 1.2, 1.0}, 0.5));
  EXPECT_FALSE(is_clear(map, {1e30, 0, 0}, 0.5));
  EXPECT_FALSE(is_clear(map, {NAN, 1, 1}, 0.5));
  EXPECT_FALSE(segment_clear(map, {1.4, 1.2, 1.0}, {1.4, std::numeric_limits<double>::infinity(), 1.0}, 0.5));
}

TEST(Clearance, MoreThanFourteenCellsIsAnErrorThatSaysSo) {
  try {
    ClearanceRule rule(14.5);
    FAIL() << "no error";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("14 cells"), std::string::npos);
  }
}

}  // namespace
}  // namespace karst::core
