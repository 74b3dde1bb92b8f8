#include <gtest/gtest.h>

#include <karst/testing/bench.h>

namespace {

using karst::testing::Bench;
using karst::testing::DrawnMap;

// A shaft: s at its foot, a beside it, b half way up, c at the top.
DrawnMap shaft() { return {1.0, {"as", "#.", "#b", "#.", "#c"}}; }

TEST(HighestFrontier, RanksByHeight) {
  const DrawnMap map = shaft();
  Bench bench(karst_plugin_entry(), map);
  bench.position = map.place('s');
  bench.offer(1, map.place('a'), map.place('a'));
  bench.offer(2, map.place('b'), map.place('b'));
  bench.offer(3, map.place('c'), map.place('c'));
  const karst::Decision d = bench.decide();
  ASSERT_EQ(d.goals.size(), 3u);
  EXPECT_EQ(d.goals[0].frontier_id, 3u);
  EXPECT_EQ(d.goals[1].frontier_id, 2u);
  EXPECT_EQ(d.goals[2].frontier_id, 1u);
  EXPECT_NE(d.goals[0].why.find("4.0 m above"), std::string::npos) << d.goals[0].why;
}

TEST(HighestFrontier, LeavesAlittleHeightForAMuchLongerWay) {
  const DrawnMap map(1.0, {"a.s" + std::string(60, '.') + "b"});
  Bench bench(karst_plugin_entry(), map);
  bench.position = map.place('s');
  bench.offer(1, map.place('a'), map.place('a'));
  bench.offer(2, map.place('b'), map.place('b') + karst::Vec3(0, 0, 1));
  EXPECT_EQ(bench.decide().goals.at(0).frontier_id, 1u) << "one metre higher is not worth 60 m of flight";
}

TEST(HighestFrontier, SaysWhenItIsBelow) {
  const DrawnMap map = shaft();
  Bench bench(karst_plugin_entry(), map);
  bench.position = map.place('c');
  bench.offer(1, map.place('s'), map.place('s'));
  EXPECT_NE(bench.decide().goals.at(0).why.find("4.0 m below"), std::string::npos);
}

}  // namespace
