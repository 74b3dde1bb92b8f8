// The core's answers against the drawn host's, which steps along rays and counts cell by cell.
#include "sdk/host/services/snapshot.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/unit/host/services/drawn.h"

namespace karst::test {
namespace {

using testing::DrawnHost;

constexpr int kSide = 8;

DrawnHost& drawn() {
  static DrawnHost host([] {
    unsigned s = 7;
    return scattered(kSide, 60, 15,
                     [&] { return static_cast<int>((s = s * 1664525u + 1013904223u) >> 16) % 100; });
  }());
  return host;
}

rc::Gen<double> coordinate() {
  return rc::gen::map(rc::gen::inRange(-100, 501),
                      [](int v) { return 0.01 * v + 0.00347; });  // never on a border
}
rc::Gen<karst_vec3_t> point() {
  return rc::gen::construct<karst_vec3_t>(coordinate(), coordinate(), coordinate());
}

TEST(Snapshot, CountsInABoxAreThoseCountedCellByCell) {
  const core::VoxelMap map = to_core_map(drawn().map());
  EXPECT_TRUE(rc::check([&] {
    const karst_vec3_t a = *point(), b = *point();
    const karst_box_t box = {{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
                             {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
    const karst_cell_counts_t counts = host::count_in_box(map, box).value();
    karst_cell_counts_t expected{};
    drawn().host()->map->count_in_boxes(drawn().host(), drawn().map_handle(), &box, 1, &expected, nullptr);
    RC_ASSERT(counts.free == expected.free);
    RC_ASSERT(counts.occupied == expected.occupied);
    RC_ASSERT(counts.unknown == expected.unknown);
  }));
}

TEST(Snapshot, DistanceToRockIsTheLeastToAnyOccupiedCell) {
  const core::VoxelMap map = to_core_map(drawn().map());
  EXPECT_TRUE(rc::check([&] {
    const karst_vec3_t p = *point();
    const double limit_m = 0.1 * *rc::gen::inRange(1, 60);
    double expected_m = limit_m;
    map.for_each_known([&](const core::CellKey& k, core::Cell cell, float) {
      if (cell == core::Cell::occupied)
        expected_m = std::min(expected_m, (map.center_of(k) - host::to_core(p)).norm());
    });
    core::WorkBudget work(host::kMaxRockWork);
    RC_ASSERT(host::distance_to_rock(map, host::to_core(p), limit_m, work) == expected_m);
    double drawn_m = -1;
    drawn().host()->map->distances_to_rock(drawn().host(), drawn().map_handle(), &p, 1, limit_m, &drawn_m,
                                           nullptr);
    RC_ASSERT(std::abs(drawn_m - expected_m) < 1e-9);
  }));
}

TEST(Snapshot, DistanceToRockEndsWithTheWorkAllowed) {
  const core::VoxelMap nothing{core::MapOptions{}};
  core::WorkBudget work(1000);
  EXPECT_EQ(host::distance_to_rock(nothing, {0.1, 0.1, 0.1}, 0.5, work), 0.5);
  EXPECT_FALSE(host::distance_to_rock(nothing, {0.1, 0.1, 0.1}, 5, work));
}

TEST(Snapshot, CountsInABoxOfAnySizeAreExactOrRefused) {
  const core::VoxelMap map = to_core_map(drawn().map());  // cells of 0.5 m
  // One cell in y and z, and in x 2^61 cells' edges with both ends on a border.
  const double far = 0x1p59;
  const auto line = host::count_in_box(map, {{-far, 100.1, 100.1}, {far, 100.4, 100.4}});
  ASSERT_TRUE(line);
  EXPECT_EQ(line->unknown, std::uint64_t{1} << 61);
  const auto cube = [&](double half_m) {
    return host::count_in_box(map, {{-half_m, -half_m, -half_m}, {half_m, half_m, half_m}});
  };
  const host::Snapshot all{&map, 0, nullptr};
  const std::uint64_t known = host::info_of(all).free_cells + host::info_of(all).occupied_cells;
  ASSERT_TRUE(cube(500'000));
  EXPECT_EQ(cube(500'000)->unknown, std::uint64_t{2'000'000} * 2'000'000 * 2'000'000 - known);
  EXPECT_FALSE(cube(0x1p20)) << "2^66 cells";
  EXPECT_FALSE(cube(1e300));
}

TEST(Snapshot, RayFarOutsideTheWorldIsInTheUnknown) {
  const core::VoxelMap map = to_core_map(drawn().map());
  const karst_segment_t ray = {{1e300, 0, 0}, {1e300, 0, 0}};
  EXPECT_EQ(host::cast_ray(map, ray, false).state, KARST_CELL_UNKNOWN);
  EXPECT_EQ(host::cast_ray(map, ray, true).state, KARST_CELL_FREE);
}

TEST(Snapshot, SurfaceIsThatFoundCellByCell) {
  const core::VoxelMap map = to_core_map(drawn().map());
  const karst_box_t box = {{0.3, 0.3, 0.3}, {3.0, 3.5, 2.9}};
  const std::vector<karst_vec3_t> found = host::surface_in_box(map, box);
  std::vector<karst_vec3_t> expected(1000);
  std::uint64_t total = 0;
  drawn().host()->map->surface_cells(drawn().host(), drawn().map_handle(), box, expected.data(), 1000, &total,
                                     nullptr);
  ASSERT_GT(total, 10u);
  ASSERT_EQ(found.size(), total);
  for (std::size_t i = 0; i < total; ++i) {
    EXPECT_DOUBLE_EQ(found[i].x, expected[i].x) << i;
    EXPECT_DOUBLE_EQ(found[i].y, expected[i].y) << i;
    EXPECT_DOUBLE_EQ(found[i].z, expected[i].z) << i;
  }
}

TEST(Snapshot, RaysEndWhereSteppingAlongThemEnds) {
  const core::VoxelMap map = to_core_map(drawn().map());
  int stopped = 0, grazing = 0, all = 0;
  EXPECT_TRUE(rc::check([&] {
    const karst_segment_t ray = {*point(), *point()};
    const bool through = *rc::gen::arbitrary<bool>();
    const karst_ray_end_t end = host::cast_ray(map, ray, through);
    karst_ray_end_t expected{};
    const std::uint32_t flags = through ? std::uint32_t{KARST_RAY_THROUGH_UNKNOWN} : 0u;
    drawn().host()->map->cast_rays(drawn().host(), drawn().map_handle(), &ray, 1, flags, &expected, nullptr);
    ++all;
    stopped += end.state != KARST_CELL_FREE;
    // Steps of a hundredth of a cell miss a cell whose corner the ray only grazes: the exact walk may stop
    // earlier, never later.
    if (end.state != expected.state || end.length_m != expected.length_m) {
      ++grazing;
      RC_ASSERT(end.state != KARST_CELL_FREE);
    }
  }));
  EXPECT_GT(stopped, all / 5);
  EXPECT_LT(grazing, all / 10);
}

TEST(Snapshot, CopyHoldsTheSameCellsAndStaysAsItWas) {
  core::VoxelMap map = to_core_map(drawn().map());
  host::Snapshot live;
  live.map = &map;
  live.revision = map.revision();
  const auto copy = host::copy_of(live);
  map.assign({0, 0, 0}, kSide, 2.0f);
  for (const auto& [i, cell] : drawn().map().known())
    EXPECT_EQ(static_cast<int>(copy->map->at(core::CellKey{i.x, i.y, i.z})), static_cast<int>(cell));
  EXPECT_EQ(host::info_of(*copy).free_cells + host::info_of(*copy).occupied_cells,
            drawn().map().known().size());
  EXPECT_EQ(host::info_of(*copy).revision, live.revision);
}

}  // namespace
}  // namespace karst::test
