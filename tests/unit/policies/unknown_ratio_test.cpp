#include <gtest/gtest.h>

#include <karst/testing/bench.h>

#include <algorithm>

namespace {

using karst::testing::Bench;
using karst::testing::DrawnMap;
using karst::testing::Index;

// At a the unknown is one cell in a corner, at b the map ends.
DrawnMap passage() {
  return {1.0, {R"(
    ###############
    ?.............b
    #.............b
    #a.....s......b
    ###############)"}};
}

/// By counting the drawing's cells one by one.
double ratio_around(const DrawnMap& map, const karst::Vec3& center, double half_edge_m) {
  double unknown = 0, free = 0;
  for (int x = -20; x < 40; ++x)
    for (int y = -20; y < 40; ++y)
      for (int z = -20; z < 40; ++z) {
        const karst::Vec3 d = map.center_of({x, y, z}) - center;
        if (std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) > half_edge_m) continue;
        unknown += map.at(Index{x, y, z}) == karst::Cell::unknown;
        free += map.at(Index{x, y, z}) == karst::Cell::free;
      }
  return unknown / std::max(free, 1.0);
}

TEST(UnknownRatio, ScoreIsTheRatioCountedCellByCell) {
  const DrawnMap map = passage();
  const Bench::Values only_ratio = {{"path_weight", "0"},
                                    {"turn_cost", "0"},
                                    {"ratio_worth", "1"},
                                    {"half_edge", "1.2"},
                                    {"max_ratio", "1000"}};
  Bench bench(karst_plugin_entry(), map, only_ratio);
  bench.position = map.place('s');
  bench.offer(1, map.place('a'), map.place('a'));
  bench.offer(2, map.place('b'), map.place('b'));
  const karst::Decision d = bench.decide();
  ASSERT_EQ(d.goals.size(), 2u);
  for (const karst::Goal& g : d.goals)
    EXPECT_DOUBLE_EQ(g.score, ratio_around(map, map.place(g.frontier_id == 1 ? 'a' : 'b'), 1.2));
  EXPECT_EQ(d.goals[0].frontier_id, 2u) << "the map ends there";
  EXPECT_GT(d.goals[0].score, d.goals[1].score);
}

TEST(UnknownRatio, LargerRatiosThanTheCapCountAlike) {
  const DrawnMap map = passage();
  Bench bench(karst_plugin_entry(), map, {{"max_ratio", "0.1"}, {"turn_cost", "0"}});
  bench.position = map.place('s') + karst::Vec3(1, 0, 0);
  bench.offer(1, map.place('b'), map.place('b'));
  bench.offer(2, map.place('a'), map.place('a'));
  EXPECT_EQ(bench.decide().goals.at(0).frontier_id, 1u) << "equal ratios: the nearer one";
}

TEST(UnknownRatio, WorksWithoutAnyFrontier) {
  Bench bench(karst_plugin_entry(), passage(), {{"patience", "0"}});
  EXPECT_EQ(bench.decide().outcome, karst_outcome_t{KARST_OUTCOME_EXPLORED});
}

}  // namespace
