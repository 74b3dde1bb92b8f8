#include "core_stack/planning/passages/slices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/planning/passages/drawn_caves.h"

namespace karst::core {
namespace {

using testing::box;
using testing::either;
using testing::map_of;
using testing::parts_of;

TEST(Marched, DistancesAreNearlyThoseOfStraightLines) {
  // Cubes of a metre.
  const VoxelMap map = map_of(box({0, 0, 0}, {24, 24, 10}), {-1, -1, -1}, {25, 25, 11}, 0.5);
  for (const Vec3& start : {Vec3(0.6, 0.6, 0.6), Vec3(12.5, 12.5, 5.5)}) {
    const FreeParts space = parts_of(map, start);
    ASSERT_EQ(space.parts.size(), 24u * 24 * 10);
    const std::vector<double> distance = marched(space);
    for (std::size_t i = 0; i < distance.size(); ++i) {
      const Vec3 line = space.parts[i].middle - space.parts[space.start].middle;
      EXPECT_GE(distance[i], line.norm() - 1e-9);
      EXPECT_LE(distance[i], 1.06 * line.norm() + 0.7) << "of the first order, worst at the start";
      if ((line.array().abs() > 1e-9).count() == 1) {
        EXPECT_NEAR(distance[i], line.norm(), 1e-9);
      }
    }
  }
}

TEST(Slices, AreChainedAlongATunnelAndForkWithIt) {
  const VoxelMap tunnel = map_of(box({0, 0, 0}, {40, 3, 3}), {-1, -1, -1}, {41, 4, 4});
  const FreeParts space = parts_of(tunnel, {0.5, 1.5, 1.5});
  const Slices slices = sliced(space);
  EXPECT_NEAR(static_cast<double>(slices.slices.size()), 40 / 1.6, 1.5);
  for (std::uint32_t s = 0; s < slices.slices.size(); ++s) {
    EXPECT_EQ(slices.slices[s].band, static_cast<std::int32_t>(s)) << "one for each band, in their order";
    EXPECT_EQ(slices.slices[s].next.size(), s == 0 || s + 1 == slices.slices.size() ? 1u : 2u);
  }
  const VoxelMap tee =
      map_of(either(box({0, 0, 0}, {40, 3, 3}), box({18, 0, 0}, {21, 30, 3})), {-1, -1, -1}, {41, 31, 4});
  const Slices forked = sliced(parts_of(tee, {0.5, 1.5, 1.5}));
  const auto most =
      std::max_element(forked.slices.begin(), forked.slices.end(),
                       [](const Slice& a, const Slice& b) { return a.next.size() < b.next.size(); });
  EXPECT_EQ(most->next.size(), 3u);
}

TEST(Slices, TouchOnlyThoseOfTheBandsBesideThemAndHoldEverything) {
  const VoxelMap map =
      map_of(either(box({0, 0, 0}, {30, 12, 5}), box({10, 0, 0}, {13, 12, 20})), {-1, -1, -1}, {31, 13, 21});
  const FreeParts space = parts_of(map, {1, 1, 1});
  const Slices slices = sliced(space);
  std::uint64_t parts = 0, free = 0;
  for (std::uint32_t s = 0; s < slices.slices.size(); ++s) {
    const Slice& slice = slices.slices[s];
    parts += slice.parts;
    free += slice.free_cells;
    EXPECT_EQ(slices.slice_of[slice.middle], s);
    for (const std::uint32_t n : slice.next) {
      EXPECT_EQ(std::abs(slices.slices[n].band - slice.band), 1);
      const auto& back = slices.slices[n].next;
      EXPECT_TRUE(std::binary_search(back.begin(), back.end(), s));
    }
  }
  EXPECT_EQ(parts, space.parts.size());
  EXPECT_EQ(free, map.free_cells());
}

}  // namespace
}  // namespace karst::core
