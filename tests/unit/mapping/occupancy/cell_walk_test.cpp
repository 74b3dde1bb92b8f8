#include "core_stack/mapping/occupancy/cell_walk.h"

#include <gtest/gtest.h>

#include <set>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

std::vector<CellKey> cells_of(const Vec3& from, const Vec3& to, double resolution_m) {
  std::vector<CellKey> cells;
  traverse(from, to, resolution_m, [&](const CellKey& k) {
    cells.push_back(k);
    return true;
  });
  return cells;
}

CellKey key(const Vec3& p, double resolution_m) {
  const Vec3 k = (p / resolution_m).array().floor();
  return {static_cast<int>(k.x()), static_cast<int>(k.y()), static_cast<int>(k.z())};
}

/// Slab test: does the segment meet the closed cell, grown by `slack` cells?
bool meets(const Vec3& from, const Vec3& to, const CellKey& k, double slack) {
  const Vec3 low = Vec3(k.x, k.y, k.z) - Vec3::Constant(slack), high = low + Vec3::Constant(1 + 2 * slack);
  double enter = 0, leave = 1;
  for (int a = 0; a < 3; ++a) {
    const double d = to[a] - from[a];
    if (std::abs(d) < 1e-15) {
      if (from[a] < low[a] || from[a] > high[a]) return false;
      continue;
    }
    const double t0 = (low[a] - from[a]) / d, t1 = (high[a] - from[a]) / d;
    enter = std::max(enter, std::min(t0, t1)), leave = std::min(leave, std::max(t0, t1));
  }
  return enter <= leave;
}

void expect_exact_walk(const Vec3& from, const Vec3& to) {
  const double resolution_m = 0.2;
  const std::vector<CellKey> cells = cells_of(from, to, resolution_m);
  ASSERT_FALSE(cells.empty());
  EXPECT_EQ(cells.front(), key(from, resolution_m));
  EXPECT_EQ(cells.back(), key(to, resolution_m));
  const CellKey a = cells.front(), b = cells.back();
  EXPECT_EQ(cells.size(), 1u + std::abs(b.x - a.x) + std::abs(b.y - a.y) + std::abs(b.z - a.z));
  for (std::size_t i = 1; i < cells.size(); ++i) {
    const CellKey &p = cells[i - 1], &q = cells[i];
    EXPECT_EQ(std::abs(p.x - q.x) + std::abs(p.y - q.y) + std::abs(p.z - q.z), 1)
        << "not face to face at " << i;
  }
  for (const CellKey& k : cells) EXPECT_TRUE(meets(from / resolution_m, to / resolution_m, k, 1e-6));
  // Whatever lies on the segment well inside a cell must have been visited.
  const std::set<CellKey> visited(cells.begin(), cells.end());
  for (int i = 0; i <= 2000; ++i) {
    const Vec3 p = from + (to - from) * (i / 2000.0);
    const Vec3 cell = p / resolution_m;
    const Vec3 inside = cell.array() - cell.array().floor();
    if (inside.minCoeff() > 1e-6 && inside.maxCoeff() < 1 - 1e-6) {
      EXPECT_TRUE(visited.contains(key(p, resolution_m)));
    }
  }
}

TEST(CellWalk, VisitsExactlyTheCellsASegmentPasses) {
  Random random(11);
  for (int i = 0; i < 300; ++i) {
    const auto point = [&] {
      return Vec3(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
    };
    expect_exact_walk(point(), point());
  }
}

TEST(CellWalk, HandlesSegmentsAlongAxesThroughCornersAndOfNoLength) {
  expect_exact_walk(Vec3(0.1, 0.1, 0.1), Vec3(5.1, 0.1, 0.1));
  expect_exact_walk(Vec3(0.1, 0.1, 0.1), Vec3(0.1, 0.1, -5.1));
  expect_exact_walk(Vec3(0.1, 0.1, 0.1), Vec3(4.1, 4.1, 4.1));
  expect_exact_walk(Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, 1.0));
  expect_exact_walk(Vec3(0, 0, 0), Vec3(0, 0, 0));
  expect_exact_walk(Vec3(0.2, 0.2, 0.2), Vec3(0.2 - 1e-12, 0.2, 0.2));
  expect_exact_walk(Vec3(-0.0, 0.4, 0.6), Vec3(-3.0, 0.4, 0.6));
}

TEST(CellWalk, ReachesTheEndOfVeryLongSegments) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const auto point = [&] {
      return Vec3(random.uniform(-3000, 3000), random.uniform(-3000, 3000), random.uniform(-3000, 3000));
    };
    const Vec3 a = point(), b = point();
    EXPECT_EQ(cells_of(a, b, 0.2).back(), key(b, 0.2));
  }
}

TEST(CellWalk, StopsWhenToldTo) {
  int visits = 0;
  traverse(Vec3(0.1, 0.1, 0.1), Vec3(9, 9, 9), 0.2, [&](const CellKey&) { return ++visits < 4; });
  EXPECT_EQ(visits, 4);
}

TEST(CellWalk, VisitsNothingWhenAnEndIsNoPlace) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(cells_of(Vec3(0, nan, 0), Vec3(1, 1, 1), 0.2).empty());
  EXPECT_TRUE(cells_of(Vec3(0, 0, 0), Vec3(inf, 1, 1), 0.2).empty());
  EXPECT_TRUE(cells_of(Vec3(0, 0, 0), Vec3(1, 1, -1e300), 0.2).empty());
}

TEST(PackedCell, KeepsCoordinatesOrderAndBlock) {
  Random random(2);
  const auto coordinate = [&] {
    return static_cast<std::int32_t>(random.uniform(-kPackedLimit, kPackedLimit));
  };
  for (int i = 0; i < 1000; ++i) {
    const CellKey a{coordinate(), coordinate(), coordinate()}, b{a.x, coordinate(), coordinate()};
    EXPECT_EQ(unpack(pack(a)), a);
    EXPECT_EQ(pack(a) < pack(b), a < b);
    EXPECT_EQ(unpack(pack(a) & ~kInBlock), (CellKey{a.x & ~7, a.y & ~7, a.z & ~7}));
  }
}

}  // namespace
}  // namespace karst::core
