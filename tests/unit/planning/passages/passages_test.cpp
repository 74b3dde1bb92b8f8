// Passages of caves whose graph is known from how they are drawn.
#include "core_stack/planning/passages/passages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "core_stack/common/random.h"
#include "tests/unit/planning/passages/drawn_caves.h"

namespace karst::core {
namespace {

using testing::box;
using testing::circle;
using testing::Depth;
using testing::either;
using testing::map_of;
using testing::tube;
using testing::without;
using Kind = PassageEnd::Kind;

PassageMap passages_of(const VoxelMap& map, const Vec3& start) {
  WorkBudget work(kMaxPassageWork);
  return find_passages(map, start, work).value();
}

/// How many junctions, dead ends, open ends and rings there are, and how many passages.
struct Counts {
  int junctions = 0, dead_ends = 0, open_ends = 0, rings = 0, passages = 0;
  bool operator==(const Counts&) const = default;
};
void PrintTo(const Counts& c, std::ostream* out) {
  *out << c.junctions << " junctions, " << c.dead_ends << " dead ends, " << c.open_ends << " open ends, "
       << c.rings << " rings, " << c.passages << " passages";
}
Counts counts(const PassageMap& found) {
  Counts c;
  for (const PassageEnd& e : found.ends)
    ++(e.kind == Kind::junction   ? c.junctions
       : e.kind == Kind::dead_end ? c.dead_ends
       : e.kind == Kind::open_end ? c.open_ends
                                  : c.rings);
  c.passages = static_cast<int>(found.passages.size());
  return c;
}

Depth level_tube() { return tube({{0.1, 0.2, 0.1}, {60.1, 0.2, 0.1}}, 2); }
VoxelMap map_of_level_tube() { return map_of(level_tube(), {-4, -4, -4}, {64, 4, 4}); }
Depth tee() { return either(tube({{-30, 0, 0}, {30, 0, 0}}, 2), tube({{0, 0, 0}, {0, 25, 0}}, 2)); }
VoxelMap map_of_tee(double resolution_m = 0.2) {
  return map_of(tee(), {-33, -3, -3}, {33, 28, 3}, resolution_m);
}

TEST(Passages, TubeIsOneOfItsLengthWidthHeightAndVolume) {
  for (const double start_x : {1.0, 30.0, 59.0}) {
    const PassageMap found = passages_of(map_of_level_tube(), {start_x, 0, 0});
    ASSERT_EQ(counts(found), (Counts{0, 2, 0, 0, 1})) << start_x;
    const Passage& p = found.passages[0];
    EXPECT_NEAR(p.length_m, 60, 3) << "from the middle of its first slice to that of its last";
    EXPECT_NEAR(p.mean_width_m, 4, 0.25);
    EXPECT_NEAR(p.least_width_m, 4, 0.4);
    EXPECT_NEAR(p.mean_height_m, 4, 0.25);
    EXPECT_NEAR(p.least_height_m, 4, 0.4);
    EXPECT_NEAR(p.volume_m3, 4 * std::numbers::pi * 60 + 32.0 / 3 * std::numbers::pi, 20);
    EXPECT_EQ(p.frontier_m2, 0);
    EXPECT_EQ(p.ends, (std::array<std::uint32_t, 2>{0, 1}));
    EXPECT_LE(found.ends[0].from_start_m, found.ends[1].from_start_m);
    for (const PassageEnd& e : found.ends) EXPECT_EQ(e.ways, 1u);
  }
}

TEST(Passages, SizesOfASquareCorridorAreExact) {
  const PassageMap found =
      passages_of(map_of(box({0, 0, 0}, {40, 3.2, 2.4}), {-1, -1, -1}, {41, 4, 3}), {0.5, 1.5, 1});
  ASSERT_EQ(counts(found), (Counts{0, 2, 0, 0, 1}));
  const Passage& p = found.passages[0];
  EXPECT_NEAR(p.mean_width_m, 3.2, 1e-9);
  EXPECT_NEAR(p.least_width_m, 3.2, 1e-9);
  EXPECT_NEAR(p.mean_height_m, 2.4, 1e-9);
  EXPECT_NEAR(p.least_height_m, 2.4, 1e-9);
  EXPECT_NEAR(p.volume_m3, 40 * 3.2 * 2.4, 1e-6);
  EXPECT_NEAR(p.middle.x(), 20, 2);
  EXPECT_NEAR(p.middle.y(), 1.6, 0.2);
  EXPECT_NEAR(found.ends[1].from_start_m, 39, 2);
}

TEST(Passages, TeeIsAJunctionOfThree) {
  for (const double resolution_m : {0.1, 0.2, 0.25, 0.3, 0.5})
    for (const Vec3& start : {Vec3(-28, 0, 0), Vec3(0, 24, 0), Vec3(0, 0, 0)}) {
      const PassageMap found = passages_of(map_of_tee(resolution_m), start);
      ASSERT_EQ(counts(found), (Counts{1, 3, 0, 0, 3})) << resolution_m << " from " << start.transpose();
      double length_m = 0;
      for (const Passage& p : found.passages) {
        EXPECT_NEAR(p.mean_width_m, 4, 0.6);
        length_m += p.length_m;
      }
      EXPECT_NEAR(length_m, 85, 9);
      for (const PassageEnd& e : found.ends)
        if (e.kind == Kind::junction) {
          EXPECT_LT(e.position.norm(), 4);
          EXPECT_EQ(e.ways, 3u);
        }
    }
}

TEST(Passages, CrossingIsOneJunctionOfFour) {
  const PassageMap found =
      passages_of(map_of(either(tube({{-30, 0, 0}, {30, 0, 0}}, 2), tube({{0, -25, 0}, {0, 25, 0}}, 2)),
                         {-33, -28, -3}, {33, 28, 3}),
                  {-28, 0, 0});
  ASSERT_EQ(counts(found), (Counts{1, 4, 0, 0, 4}));
  EXPECT_EQ(found.ends[1].ways, 4u) << "behind the dead end near the start";
  EXPECT_EQ(found.ends[1].kind, Kind::junction);
}

TEST(Passages, RingIsAPassageThatComesBack) {
  const PassageMap found = passages_of(map_of(tube(circle(15), 2), {-18, -18, -3}, {18, 18, 3}), {15, 0, 0});
  ASSERT_EQ(counts(found), (Counts{0, 0, 0, 1, 1}));
  EXPECT_EQ(found.passages[0].ends, (std::array<std::uint32_t, 2>{0, 0}));
  EXPECT_EQ(found.ends[0].ways, 2u);
  EXPECT_NEAR(found.passages[0].length_m, 2 * std::numbers::pi * 15, 3);
  EXPECT_NEAR(found.passages[0].mean_width_m, 4, 0.2);

  const PassageMap stalk = passages_of(
      map_of(either(tube(circle(15), 2), tube({{15, 0, 0}, {40, 0, 0}}, 2)), {-18, -18, -3}, {43, 18, 3}),
      {38, 0, 0});
  ASSERT_EQ(counts(stalk), (Counts{1, 1, 0, 0, 2}));
  EXPECT_EQ(stalk.ends[1].ways, 3u);
  EXPECT_EQ(stalk.passages[1].ends, (std::array<std::uint32_t, 2>{1, 1})) << "from the junction to itself";
}

TEST(Passages, HallWithThreeExitsIsOneJunction) {
  const Depth hall = box({-10, -10, 0}, {10, 10, 6});
  const Depth exits =
      either(either(box({-40, -2, 0}, {0, 2, 4}), box({0, -2, 0}, {40, 2, 4})), box({-2, 0, 0}, {2, 40, 4}));
  const VoxelMap map = map_of(either(hall, exits), {-41, -12, -1}, {41, 41, 7});
  for (const Vec3& start : {Vec3(-38, 0, 2), Vec3(0, 38, 2), Vec3(0, 0, 2)}) {
    const PassageMap found = passages_of(map, start);
    ASSERT_EQ(counts(found), (Counts{1, 3, 0, 0, 3})) << start.transpose();
    for (const PassageEnd& e : found.ends)
      if (e.kind == Kind::junction) {
        EXPECT_GT(e.width_m, 18);
        EXPECT_NEAR(e.height_m, 6, 1e-9);
        EXPECT_GT(e.volume_m3, 1800) << "of the hall's 2400";
        EXPECT_LT(e.position.norm(), 7);
      }
    for (const Passage& p : found.passages) EXPECT_NEAR(p.least_width_m, 4, 0.3);
  }
}

TEST(Passages, RoomIsAPassageWithTwoEnds) {
  const PassageMap ball =
      passages_of(map_of(tube({{0, 0, 0}, {0.01, 0, 0}}, 6), {-7, -7, -7}, {7, 7, 7}), {0, 0, 0});
  EXPECT_EQ(counts(ball), (Counts{0, 2, 0, 0, 1}));
  const PassageMap smallest =
      passages_of(map_of(tube({{0, 0, 0}, {0.01, 0, 0}}, 0.8), {-2, -2, -2}, {2, 2, 2}), {0, 0, 0});
  ASSERT_EQ(counts(smallest), (Counts{0, 2, 0, 0, 1}));
  EXPECT_NEAR(smallest.passages[0].least_width_m, 1.5, 0.2);
}

TEST(Passages, ShaftIsAPassageUpwards) {
  const PassageMap found =
      passages_of(map_of(tube({{0, 0, 0}, {0, 0, 50}}, 2.5), {-4, -4, -4}, {4, 4, 54}), {0, 0, 0});
  ASSERT_EQ(counts(found), (Counts{0, 2, 0, 0, 1}));
  EXPECT_NEAR(found.passages[0].length_m, 52, 3);
  EXPECT_NEAR(found.passages[0].mean_width_m, 5, 0.4);
  EXPECT_GT(found.passages[0].mean_height_m, 50);
}

TEST(Passages, LevelsJoinedByTwoShaftsHaveFourJunctions) {
  Depth d = either(tube({{0, 0, 0}, {60, 0, 0}}, 2), tube({{0, 0, 20}, {60, 0, 20}}, 2));
  d = either(d, either(tube({{10, 0, 0}, {10, 0, 20}}, 1.6), tube({{50, 0, 0}, {50, 0, 20}}, 1.6)));
  EXPECT_EQ(counts(passages_of(map_of(d, {-3, -3, -3}, {63, 3, 23}), {0, 0, 0})), (Counts{4, 4, 0, 0, 8}));
}

TEST(Passages, PillarsAndAlcovesSmallerThanThePassageChangeNothing) {
  Depth d = tube({{0, 0, 0}, {60, 0, 0}}, 3);
  for (const double x : {15.0, 30.0, 45.0}) d = without(d, tube({{x, 0, 0}, {x + 0.01, 0, 0}}, 0.9));
  for (const double x : {20.0, 40.0}) d = either(d, tube({{x, 0, 0}, {x, 4, 0}}, 1.2));
  EXPECT_EQ(counts(passages_of(map_of(d, {-4, -6, -4}, {64, 6, 4}), {0, 0, 0})), (Counts{0, 2, 0, 0, 1}));
}

TEST(Passages, NoiseOfSingleCellsMakesNoJunctions) {
  const auto noisy = [](const VoxelMap& map, double share, std::uint64_t seed) {
    VoxelMap out{MapOptions{}};
    Random random(seed);
    map.for_each_known([&](const CellKey& k, Cell c, float log_odds) {
      const double u = random.uniform();
      if (c == Cell::free && u < share) return;  // unknown
      out.assign(k, 1, u < 2 * share ? -log_odds : log_odds);
    });
    return out;
  };
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Counts tube = counts(passages_of(noisy(map_of_level_tube(), 0.003, seed), {1, 0, 0}));
    EXPECT_EQ(tube.junctions, 0);
    EXPECT_EQ(tube.passages, 1);
    const Counts tee = counts(passages_of(noisy(map_of_tee(), 0.003, seed), {-28, 0, 0}));
    EXPECT_EQ(tee.junctions, 1);
    EXPECT_EQ(tee.passages, 3);
  }
}

TEST(Passages, WhereTheMapEndsTheEndIsOpen) {
  const auto half = [](const Vec3& p) { return p.x() < 31; };
  const PassageMap found =
      passages_of(map_of(tube({{0, 0, 0}, {60, 0, 0}}, 2), {-4, -4, -4}, {64, 4, 4}, 0.2, half), {0, 0, 0});
  ASSERT_EQ(counts(found), (Counts{0, 1, 1, 0, 1}));
  const PassageEnd& open = found.ends[1];
  EXPECT_EQ(open.kind, Kind::open_end);
  EXPECT_NEAR(open.position.x(), 30, 1);
  EXPECT_NEAR(open.frontier_m2, 4 * std::numbers::pi, 0.5) << "the cross-section";
  EXPECT_NEAR(found.passages[0].frontier_m2, open.frontier_m2, 1e-9);
  EXPECT_EQ(found.ends[0].frontier_m2, 0);
}

TEST(Passages, OfPassagesOneCellWideInAPlan) {
  const PassageMap found = passages_of(
      map_of(either(box({0, 0, 0}, {20, 1, 1}), box({10, 0, 0}, {11, 12, 1})), {-2, -2, -2}, {22, 14, 3}, 1),
      {0.5, 0.5, 0.5});
  ASSERT_EQ(counts(found), (Counts{1, 3, 0, 0, 3}));
  for (const Passage& p : found.passages) EXPECT_EQ(p.least_width_m, 1);
}

TEST(Passages, PointsAreInThePassageOrTheJunctionAroundThem) {
  const PassageMap found = passages_of(map_of_tee(), {-28, 0, 0});
  const PassagePlace junction = found.at({0, 0.5, 0});
  EXPECT_EQ(junction.passage, kNoPassage);
  ASSERT_NE(junction.end, kNoPassage);
  EXPECT_EQ(found.ends[junction.end].kind, Kind::junction);
  EXPECT_NEAR(junction.from_start_m, 28, 3);
  for (const Vec3& p : {Vec3(-20, 1, 0), Vec3(20, -1, 0.5), Vec3(0.5, 15, 0), Vec3(29, 0, 0)}) {
    const PassagePlace place = found.at(p);
    EXPECT_EQ(place.end, kNoPassage);
    ASSERT_NE(place.passage, kNoPassage);
    EXPECT_LT((found.passages[place.passage].middle - p).norm(), 16);
    if (p.x() < 25) {
      EXPECT_NEAR(place.width_m, 4, 0.45);
    }
    EXPECT_NEAR(place.from_start_m, (p - Vec3(-28, 0, 0)).cwiseAbs().sum(), 4);
  }
  EXPECT_NE(found.at({-20, 1, 0}).passage, found.at({20, -1, 0.5}).passage);
  const PassagePlace nowhere = found.at({20, 20, 0});
  EXPECT_EQ(nowhere.passage, kNoPassage);
  EXPECT_EQ(nowhere.end, kNoPassage);
}

TEST(Passages, AreNoneWhereNothingIsFreeAndNoAnswerBeyondTheWorkAllowed) {
  const PassageMap none = passages_of(VoxelMap{MapOptions{}}, {0, 0, 0});
  EXPECT_TRUE(none.passages.empty());
  EXPECT_TRUE(none.ends.empty());
  EXPECT_EQ(none.at({0, 0, 0}).passage, kNoPassage);
  EXPECT_TRUE(passages_of(map_of_level_tube(), {0, 100, 0}).passages.empty());
  const VoxelMap map = map_of_level_tube();
  const std::size_t parts = testing::parts_of(map, {0, 0, 0}).parts.size();
  const std::uint64_t without_slices = map.free_cells() + map.occupied_cells() + kPartWork * (parts + 10);
  for (const std::uint64_t steps : {std::uint64_t{1000}, without_slices}) {
    WorkBudget work(steps);
    EXPECT_FALSE(find_passages(map, {0, 0, 0}, work).has_value()) << steps;
  }
}

void expect_same(const PassageMap& a, const PassageMap& b) {
  ASSERT_EQ(a.ends.size(), b.ends.size());
  ASSERT_EQ(a.passages.size(), b.passages.size());
  for (std::size_t i = 0; i < a.ends.size(); ++i) {
    EXPECT_EQ(a.ends[i].position, b.ends[i].position);
    EXPECT_EQ(a.ends[i].kind, b.ends[i].kind);
    EXPECT_EQ(a.ends[i].volume_m3, b.ends[i].volume_m3);
  }
  for (std::size_t i = 0; i < a.passages.size(); ++i) {
    EXPECT_EQ(a.passages[i].ends, b.passages[i].ends);
    EXPECT_EQ(a.passages[i].length_m, b.passages[i].length_m);
    EXPECT_EQ(a.passages[i].mean_width_m, b.passages[i].mean_width_m);
  }
}

TEST(Passages, DoNotDependOnTheOrderInWhichCellsBecameKnown) {
  const VoxelMap map = map_of_tee();
  std::vector<std::pair<CellKey, float>> cells;
  map.for_each_known([&](const CellKey& k, Cell, float log_odds) { cells.emplace_back(k, log_odds); });
  const PassageMap first = passages_of(map, {-28, 0, 0});
  Random random(1);
  for (int order = 0; order < 2; ++order) {
    if (order == 0) std::reverse(cells.begin(), cells.end());
    if (order == 1)
      for (std::size_t i = cells.size() - 1; i > 0; --i)
        std::swap(cells[i], cells[static_cast<std::size_t>(random.uniform(0, static_cast<double>(i)))]);
    VoxelMap other{MapOptions{}};
    other.assign({200, 200, 200}, 1, 2.0f);  // a block that the other map does not have
    for (const auto& [key, log_odds] : cells) other.assign(key, 1, 2 * log_odds);
    expect_same(first, passages_of(other, {-28, 0, 0}));
  }
}

/// Tunnels of a random radius along random edges of a lattice of 3 x 3 x 2 places, all connected.
struct Lattice {
  static constexpr double step_m = 13;
  Depth depth;
  Counts expected;

  explicit Lattice(std::uint64_t seed) {
    Random random(seed);
    const double radius_m = random.uniform(1.2, 2.0);
    std::vector<std::pair<int, int>> all;
    for (int i = 0; i < 18; ++i) {
      if (i % 3 < 2) all.emplace_back(i, i + 1);
      if (i / 3 % 3 < 2) all.emplace_back(i, i + 3);
      if (i < 9) all.emplace_back(i, i + 9);
    }
    std::set<int> reached{0};
    std::set<std::pair<int, int>> dug;
    std::map<int, int> ways;
    while (dug.size() < 14) {
      const auto& edge = all[static_cast<std::size_t>(random.uniform(0, static_cast<double>(all.size())))];
      if (reached.count(edge.first) + reached.count(edge.second) == 0 || !dug.insert(edge).second) continue;
      for (const int place : {edge.first, edge.second}) {
        reached.insert(place);
        ++ways[place];
      }
      const Depth tunnel = tube({at(edge.first), at(edge.second)}, radius_m);
      depth = depth ? either(depth, tunnel) : tunnel;
    }
    // Places with two ways are bends of one passage.
    expected.passages = static_cast<int>(dug.size());
    for (const auto& [place, n] : ways) {
      expected.junctions += n >= 3;
      expected.dead_ends += n == 1;
      expected.passages -= n == 2;
    }
  }
  static Vec3 at(int place) { return step_m * Vec3(place % 3, place / 3 % 3, place / 9); }
};

TEST(Passages, OfRandomTunnelsAreThoseThatWereDugHoweverTheGridIsTurned) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Lattice lattice(seed);
    const VoxelMap map = map_of(lattice.depth, {-3, -3, -3}, {29, 29, 16});
    std::vector<double> lengths_m;
    for (int turn = 0; turn < 3; ++turn) {
      VoxelMap turned{MapOptions{}};  // by 90 degrees about the vertical, and about a horizontal axis
      map.for_each_known([&](const CellKey& k, Cell, float log_odds) {
        const CellKey to = turn == 0   ? k
                           : turn == 1 ? CellKey{-k.y - 1, k.x, k.z}
                                       : CellKey{k.z, k.y, -k.x - 1};
        turned.assign(to, 1, log_odds);
      });
      const PassageMap found = passages_of(turned, {0.03, 0.02, 0.01});
      EXPECT_EQ(counts(found), lattice.expected) << "seed " << seed << ", turn " << turn;
      double length_m = 0;
      for (const Passage& p : found.passages) length_m += p.length_m;
      lengths_m.push_back(length_m);
    }
    EXPECT_NEAR(lengths_m[1], lengths_m[0], 0.06 * lengths_m[0]);
    EXPECT_NEAR(lengths_m[2], lengths_m[0], 0.06 * lengths_m[0]);
  }
}

}  // namespace
}  // namespace karst::core
