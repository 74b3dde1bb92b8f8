// What may be explored in a region, against its definition cell by cell.
#include "sdk/evaluation/reachable/reachable_in_region.h"

#include <gtest/gtest.h>

#include "core_stack/common/error.h"
#include "tests/unit/evaluation/reachable/boxes.h"

namespace karst::evaluation {
namespace {

using core::FlightRegion;
using core::Vec3;

/// 24 x 5 x 4 m along x, with a side passage of 5 x 10 m to the north from x = 8 to 13.
Reachable junction(const Vec3& start) {
  std::set<std::array<int, 3>> cells;
  test::fill(cells, {0, 0, 0}, {24, 5, 4});
  test::fill(cells, {8, 5, 0}, {13, 15, 4});
  return find_reachable(test::lattice_mesh(cells, 1.0, Vec3(0.03, -0.07, 0.05)), start, {}, "junction");
}

const Vec3 kStart(2.1, 2.5, 1.9);

std::vector<CellKey> cells_of(const CellSet& set) {
  std::vector<CellKey> out;
  set.for_each([&](const CellKey& k) { out.push_back(k); });
  return out;
}

TEST(ReachableInRegion, EverywhereIsTheSame) {
  const Reachable all = junction(kStart);
  const Reachable r = reachable_in_region(all, FlightRegion({}), kStart, "junction");
  EXPECT_EQ(cells_of(r.flyable), cells_of(all.flyable));
  EXPECT_EQ(cells_of(r.reachable), cells_of(all.reachable));
  EXPECT_EQ(r.volume_m3(), all.volume_m3());
}

TEST(ReachableInRegion, OnlyWhatLiesInsideCounts) {
  const Reachable all = junction(kStart);
  FlightRegion::Limits limits;
  limits.keep_in = core::box({-1, -1, -1}, {17, 20, 9});
  limits.keep_out = {core::box({7, 8, -1}, {14, 20, 9})};
  limits.margin_m = 0.53;  // no cell's centre lies just there
  const FlightRegion region(limits);
  const Reachable r = reachable_in_region(all, region, kStart, "junction");
  std::size_t expected = 0;
  all.flyable.for_each([&](const CellKey& k) {
    const Vec3 p = center_of(k, 0.2);
    const Vec3 beside = p.cwiseMax(Vec3(7, 8, -1)).cwiseMin(Vec3(14, 20, 9));  // of the box to keep out of
    const double least_m = 0.53 + 0.6;                                         // the margin and the clearance
    const bool in = p.x() <= 17 - least_m && (p - beside).norm() >= least_m;
    EXPECT_EQ(r.flyable.contains(k), in);
    expected += in;
  });
  EXPECT_EQ(r.flyable_cells, expected);
  for (const CellKey& k : cells_of(r.reachable)) EXPECT_TRUE(region.contains(center_of(k, 0.2)));
  // All of the straight passage up to the border is seen from where it may fly.
  std::size_t inside = 0;
  all.reachable.for_each([&](const CellKey& k) { inside += region.contains(center_of(k, 0.2)); });
  EXPECT_EQ(r.reachable_cells, inside);
  EXPECT_LT(r.reachable_cells, all.reachable_cells);
}

TEST(ReachableInRegion, WhatARegionCutsOffDoesNotCount) {
  const Reachable all = junction(kStart);
  FlightRegion::Limits limits;
  limits.keep_out = {core::box({5, -1, -1}, {7, 20, 9})};
  const Reachable r = reachable_in_region(all, FlightRegion(limits), kStart, "junction");
  r.flyable.for_each([](const CellKey& k) { EXPECT_LE(center_of(k, 0.2).x(), 5); });
  EXPECT_GT(r.flyable_cells, 0u);
  limits.keep_out = {core::box({-9, -9, -9}, {9, 9, 9})};
  EXPECT_THROW(reachable_in_region(all, FlightRegion(limits), kStart, "junction"), core::InputError);
}

TEST(ReachableInRegion, TheWayHomeIsLimitedAroundTheCorner) {
  const Reachable all = junction(kStart);
  FlightRegion::Limits limits;
  limits.max_home_m = 12;
  const Reachable r = reachable_in_region(all, FlightRegion(limits), kStart, "junction");
  const auto flyable_at = [&](const Vec3& p) {
    return r.flyable.contains({static_cast<int>(std::floor(p.x() / 0.2)),
                               static_cast<int>(std::floor(p.y() / 0.2)),
                               static_cast<int>(std::floor(p.z() / 0.2))});
  };
  EXPECT_TRUE(flyable_at({13.9, 2.5, 1.9}));
  EXPECT_FALSE(flyable_at({14.5, 2.5, 1.9}));
  EXPECT_TRUE(flyable_at({9.1, 8.1, 1.9}));
  EXPECT_FALSE(flyable_at({10.1, 13.5, 1.9}));  // 13.6 m in a straight line, and more around the corner
}

}  // namespace
}  // namespace karst::evaluation
