#include "core_stack/planning/passages/slice_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace karst::core {
namespace {

constexpr double kBand_m = 1.6;

/// Slices by hand: places, their widths, and which are joined.
struct Drawn {
  std::vector<Slice> slices;
  std::vector<CrossSection> sections;

  std::uint32_t add(const Vec3& center, double width_m) {
    slices.emplace_back();
    sections.push_back({center, width_m, 2});
    return static_cast<std::uint32_t>(slices.size() - 1);
  }
  void join(std::uint32_t a, std::uint32_t b) {
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
      slices[from].next.push_back(to);
      std::sort(slices[from].next.begin(), slices[from].next.end());
    }
  }
  /// A row of `count` slices a band apart that begins beside `from`. Returns the last.
  std::uint32_t row(std::uint32_t from, const Vec3& d, int count, double width_m) {
    for (int i = 0; i < count; ++i) {
      const std::uint32_t next = add(sections[from].center + kBand_m * d, width_m);
      join(from, next);
      from = next;
    }
    return from;
  }
  std::vector<SliceGroup> merged() const { return simplified(slices, sections, kBand_m); }
};

int junctions(const std::vector<SliceGroup>& groups) {
  return static_cast<int>(
      std::count_if(groups.begin(), groups.end(), [](const SliceGroup& g) { return g.next.size() >= 3; }));
}

const Vec3 kEast = Vec3::UnitX(), kNorth = Vec3::UnitY();

TEST(SliceChains, LeadFromJunctionsToEndsAndJunctions) {
  Drawn d;
  const std::uint32_t middle = d.add({0, 0, 0}, 2);
  d.row(middle, kEast, 5, 2);
  d.row(middle, kNorth, 6, 2);
  d.row(middle, -kEast, 7, 2);
  const std::vector<SliceGroup> groups = d.merged();
  std::vector<SliceChain> chains = chains_of(groups);
  ASSERT_EQ(chains.size(), 3u);
  std::size_t all = 0;
  for (const SliceChain& c : chains) {
    EXPECT_EQ(c.junctions[1], kNoGroup);
    EXPECT_NE(c.junctions[0], kNoGroup);
    EXPECT_FALSE(c.is_ring);
    all += c.groups.size();
  }
  EXPECT_EQ(all + 1, groups.size());
}

TEST(SliceChains, WithoutAJunctionAreARowARingOrASingleGroup) {
  Drawn row;
  row.row(row.add({0, 0, 0}, 2), kEast, 4, 2);
  const std::vector<SliceChain> rows = chains_of(row.merged());
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].groups.size(), 5u);
  EXPECT_FALSE(rows[0].is_ring);

  Drawn ring;
  const std::uint32_t first = ring.add({0, 0, 0}, 2);
  std::uint32_t last = ring.row(first, kEast, 5, 2);
  for (const Vec3& d : {kNorth, Vec3(-kEast)}) last = ring.row(last, d, 5, 2);
  ring.join(ring.row(last, -kNorth, 4, 2), first);
  const std::vector<SliceChain> rings = chains_of(ring.merged());
  ASSERT_EQ(rings.size(), 1u);
  EXPECT_TRUE(rings[0].is_ring);
  EXPECT_EQ(rings[0].groups.size(), 20u);

  Drawn single;
  single.add({0, 0, 0}, 2);
  const std::vector<SliceChain> singles = chains_of(single.merged());
  ASSERT_EQ(singles.size(), 1u);
  EXPECT_EQ(singles[0].groups.size(), 1u);
  EXPECT_TRUE(chains_of({}).empty());
}

TEST(Simplified, DeadEndShorterThanItIsWideBecomesPartOfThePassage) {
  for (const int length : {1, 2, 3, 5, 8}) {
    Drawn d;
    const std::uint32_t middle = d.add({0, 0, 0}, 6);
    d.row(middle, kEast, 9, 6);
    d.row(middle, -kEast, 9, 6);
    d.row(middle, kNorth, length, 6);
    // From its first centre to half a band behind the last: (length - 1/2) bands against 6 m.
    const bool is_short = (length - 0.5) * kBand_m < 6;
    const std::vector<SliceGroup> groups = d.merged();
    EXPECT_EQ(junctions(groups), is_short ? 0 : 1) << length;
    if (is_short) {
      EXPECT_EQ(groups.size(), 19u) << length;
    }
  }
}

TEST(Simplified, DeadEndsInNarrowPassagesNeedThreeSlices) {
  for (const int length : {1, 2, 3}) {
    Drawn d;
    const std::uint32_t middle = d.add({0, 0, 0}, 1.2);
    d.row(middle, kEast, 9, 1.2);
    d.row(middle, -kEast, 9, 1.2);
    d.row(middle, kNorth, length, 1.0);
    EXPECT_EQ(junctions(d.merged()), length < 3 ? 0 : 1) << length;
  }
}

TEST(Simplified, CornerOfAHallIsShortAndANarrowPassageBehindItIsNot) {
  for (const bool leads_on : {false, true}) {
    Drawn d;
    const std::uint32_t hall = d.add({0, 0, 0}, 12);
    d.row(hall, kEast, 9, 3);
    d.row(hall, -kEast, 9, 3);
    std::uint32_t last = d.row(hall, kNorth, 3, 12);
    if (leads_on) {
      d.row(last, kNorth, 5, 3);  // in all it is shorter than the hall is wide
    } else {
      for (const double width_m : {8.0, 5.0, 2.5}) last = d.row(last, kNorth, 1, width_m);
    }
    EXPECT_EQ(junctions(d.merged()), leads_on ? 1 : 0);
  }
}

TEST(Simplified, OfTwoShortDeadEndsAtTheEndOfAPassageOneIsItsEnd) {
  Drawn d;
  const std::uint32_t fork = d.row(d.add({0, 0, 0}, 4), kEast, 9, 4);
  d.row(fork, kNorth, 2, 4);
  d.row(fork, -kNorth, 1, 4);
  const std::vector<SliceGroup> groups = d.merged();
  EXPECT_EQ(junctions(groups), 0);
  EXPECT_EQ(groups.size(), 12u) << "the longer one is left";
}

TEST(Simplified, JunctionsNearerThanTheyAreWideAreOne) {
  for (const double width_m : {4.0, 12.0}) {
    Drawn d;
    const std::uint32_t a = d.add({0, 0, 0}, width_m), b = d.row(a, kEast, 5, width_m);
    d.row(a, -kEast, 9, 3);
    d.row(a, kNorth, 9, 3);
    d.row(b, kEast, 9, 3);
    d.row(b, kNorth, 9, 3);
    const std::vector<SliceGroup> groups = d.merged();
    EXPECT_EQ(junctions(groups), width_m < 5 * kBand_m ? 2 : 1) << width_m;
    EXPECT_EQ(chains_of(groups).size(), width_m < 5 * kBand_m ? 5u : 4u) << width_m;
  }
}

TEST(Simplified, LoopsAroundPillarsAreClosedAndLoopsAroundRockAreNot) {
  for (const int half : {2, 9}) {
    Drawn d;
    const std::uint32_t a = d.row(d.add({-20, 0, 0}, 7), kEast, 9, 7);
    std::uint32_t left = d.row(a, (kEast + kNorth).normalized(), half, 2.5);
    std::uint32_t right = d.row(a, (kEast - kNorth).normalized(), half, 2.5);
    left = d.row(left, (kEast - kNorth).normalized(), half, 2.5);
    right = d.row(right, (kEast + kNorth).normalized(), half - 1, 2.5);
    d.join(right, left);
    d.row(left, kEast, 9, 7);
    EXPECT_EQ(junctions(d.merged()), half == 2 ? 0 : 2) << half;
  }
}

TEST(Simplified, HallIsOneJunctionWithTheSlicesInsideIt) {
  Drawn d;
  const std::uint32_t hall = d.add({0, 0, 0}, 15);
  for (const Vec3& out : {kEast, Vec3(-kEast), kNorth}) d.row(hall, out, 12, 4);
  const std::vector<SliceGroup> groups = d.merged();
  ASSERT_EQ(junctions(groups), 1);
  const auto junction =
      std::find_if(groups.begin(), groups.end(), [](const SliceGroup& g) { return g.next.size() >= 3; });
  EXPECT_EQ(junction->core, hall);
  EXPECT_EQ(junction->slices.size(), 1u + 3 * 4) << "within 7.5 m: four bands of 1.6 m to each side";
}

TEST(Simplified, EverySliceIsInOneGroup) {
  Drawn d;
  const std::uint32_t middle = d.add({0, 0, 0}, 8);
  for (int i = 0; i < 8; ++i) {
    const double a = 0.7 * i;
    d.row(middle, {std::cos(a), std::sin(a), 0}, 1 + i, 3);
  }
  std::vector<int> times(d.slices.size());
  for (const SliceGroup& g : d.merged()) {
    EXPECT_TRUE(std::find(g.slices.begin(), g.slices.end(), g.core) != g.slices.end());
    for (const std::uint32_t s : g.slices) ++times[s];
  }
  EXPECT_EQ(std::count(times.begin(), times.end(), 1), static_cast<std::ptrdiff_t>(times.size()));
  EXPECT_TRUE(simplified({}, {}, kBand_m).empty());
}

TEST(OpenEnds, AreThoseWhoseFrontierIsAQuarterOfTheCrossSection) {
  std::vector<Slice> slices(1);
  slices[0].free_cells = 800;  // of a band of eight cells: 100 across
  const std::vector<SliceGroup> groups{{{0}, {}, 0}};
  const std::vector<std::uint32_t> last{0};
  PassageGrid grid;
  grid.cell_m = 0.2;
  grid.cube_shift = 2;
  slices[0].frontier_cells = 24;
  EXPECT_FALSE(is_open_end(last, groups, slices, grid));
  slices[0].frontier_cells = 26;
  EXPECT_TRUE(is_open_end(last, groups, slices, grid));
}

}  // namespace
}  // namespace karst::core
