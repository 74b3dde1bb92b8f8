#include <gtest/gtest.h>

#include <karst/testing/bench.h>

namespace {

using karst::Decision;
using karst::testing::Bench;
using karst::testing::DrawnMap;

// From s the window b is nearer through the wall, a is nearer by the way one can fly.
DrawnMap hairpin() {
  return {1.0, {R"(
    ###########
    ?b........#
    #########.#
    ?a..s.....#
    ###########)"}};
}

TEST(NearestFrontier, MeasuresByTheWayItFliesNotByTheCrow) {
  const DrawnMap map = hairpin();
  Bench bench(karst_plugin_entry(), map, {{"turn_cost", "0"}, {"opening_bonus", "0"}});
  bench.position = map.place('s');
  bench.offer(1, map.place('b'), map.place('b'));
  bench.offer(2, map.place('a'), map.place('a'));
  const Decision d = bench.decide();
  ASSERT_EQ(d.outcome, karst_outcome_t{KARST_OUTCOME_GOALS});
  ASSERT_EQ(d.goals.size(), 2u);
  EXPECT_EQ(d.goals[0].frontier_id, 2u);
  EXPECT_DOUBLE_EQ(d.goals[0].score, -3.0) << "three cells of one metre";
  EXPECT_NE(d.goals[0].why.find("3.0 m away"), std::string::npos) << d.goals[0].why;
}

TEST(NearestFrontier, SkipsWhatHasNoWayToIt) {
  const DrawnMap map(1.0, {R"(
    #######
    #s.#.b?
    #######)"});
  Bench bench(karst_plugin_entry(), map, {{"patience", "0"}});
  bench.position = map.place('s');
  bench.offer(1, map.place('b'), map.place('b'));
  EXPECT_EQ(bench.decide().outcome, karst_outcome_t{KARST_OUTCOME_EXPLORED});
}

TEST(NearestFrontier, PrefersWhatLiesAheadWhenBothAreNear) {
  const DrawnMap map(1.0, {R"(
    ?a..s...b?)"});
  Bench bench(karst_plugin_entry(), map);
  bench.position = map.place('s');
  bench.offer(1, map.place('a'), map.place('a'));
  bench.offer(2, map.place('b'), map.place('b'));
  bench.direction_of_flight = {1, 0, 0};
  EXPECT_EQ(bench.decide().goals.at(0).frontier_id, 2u) << "a is a metre nearer, but behind";
  bench.direction_of_flight = {-1, 0, 0};
  EXPECT_EQ(bench.decide().goals.at(0).frontier_id, 1u);
}

TEST(NearestFrontier, OpeningOutweighsANicheALittleNearer) {
  const DrawnMap map(1.0, {R"(
    ?a..s...b?)"});
  Bench bench(karst_plugin_entry(), map, {{"turn_cost", "0"}, {"opening_bonus", "5"}});
  bench.position = map.place('s');
  karst::Frontier& niche = bench.offer(1, map.place('a'), map.place('a'));
  niche.unknown_cells = 1, niche.free_cells = 99;
  karst::Frontier& opening = bench.offer(2, map.place('b'), map.place('b'));
  opening.unknown_cells = 90, opening.free_cells = 10;
  EXPECT_EQ(bench.decide().goals.at(0).frontier_id, 2u);
}

}  // namespace
